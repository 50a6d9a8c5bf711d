# demo and test install what they need on Debian (apt; sudo only where you are not root).

PACKAGES := gcc libc6-dev pkg-config libudev-dev libasound2-dev libvulkan1 mesa-vulkan-drivers \
	libxkbcommon-x11-0 libxcursor1 libxi6 libxrandr2 libx11-xcb1
TEST_PACKAGES := xvfb xdotool python3-venv libegl1 libgl1-mesa-dri
SUDO := $(shell [ "$$(id -u)" = 0 ] || echo sudo)

# What checks the dependencies; a version that is not this one is replaced.
TOOLS := cargo-machete@0.9.2 cargo-deny@0.20.2

AEYE := $(or $(CARGO_TARGET_DIR),target)/release/aeye

.PHONY: demo test matrix bench dist oracles peers cluster campaign-check kills fuzz properties check-long headless headless-test setup tools build

## Drives the bundled maps until three corner cases have happened and reports on them.
demo: build
	$(AEYE) demo --out out/demo

## Everything that CI runs; more builds than here: make matrix. Property tests try the same cases everywhere.
test: PACKAGES += $(TEST_PACKAGES)
test: export PROPTEST_RNG_SEED ?= 1
test: setup tools
	cargo fmt --all --check
	cargo machete
	cargo deny check -D unnecessary-skip -D unmatched-skip licenses bans sources
	tests/advisories.sh
	cargo clippy --release --workspace --all-targets -- -D warnings
	cargo clippy --release --workspace --no-default-features --features aeye/cuda --all-targets -- -D warnings
	cargo test --release --workspace
	python/test.sh $(dir $(AEYE))../python
	kernel/tests/portable.sh

## The same hashes, keyframes and recordings from other builds, aarch64 among them.
matrix: PACKAGES := gcc libc6-dev gcc-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user-static
matrix: setup
	tests/matrix.sh

## Benchmarks; fails when a budget is broken.
bench: setup
	cargo bench --workspace --bench budgets

## A release for this machine's architecture in dist/: both programs as tarballs, the wheel, and SHA256SUMS; each is tried.
dist: PACKAGES += python3-venv
dist: setup
	rig/aeye/dist/pack.sh $(dir $(AEYE))../dist dist
	rig/aeye/dist/try.sh dist

## Compares what is computed here with what programs of others make of the same files (Python, PyPI; TORCH=1: PyTorch's, too).
oracles: PACKAGES += python3-venv
oracles: build
	tests/oracles/run.sh $(AEYE) $(dir $(AEYE))../oracles

## Drives the same towns with SUMO (PyPI), steps environments of Gymnasium, runs networks with onnxruntime (TORCH=1: also PyTorch's exports), and says how fast each is.
peers: PACKAGES += python3-venv
peers: build
	benches/peers/run.sh $(dir $(AEYE))world_speed $(dir $(AEYE))../peers
	benches/peers/gym.sh $(dir $(AEYE))episode_speed $(dir $(AEYE))../peers
	benches/peers/engines.sh $(dir $(AEYE))picture_to_mask $(dir $(AEYE))../peers

## The same campaign alone, in shards, on Ray (PyPI) and as a Slurm array, with somebody killed in each, and an experiment: the same files.
cluster: PACKAGES += python3-venv slurm-wlm munge
cluster: build
	tests/cluster/run.sh $(AEYE) $(dir $(AEYE))../cluster

## Drives 140 km through true masks, and fails where takeovers are over twice as frequent as 0.05 a km.
campaign-check: setup
	AEYE_LOOP_KM=140 cargo test --release --workspace --test truth -- --nocapture

## Kills the program 200 times in everything that takes long; what was finished must stay.
kills: setup
	AEYE_KILLS=200 cargo test --release --workspace --test kills -- --nocapture

## Damages files for every parser, 20 minutes or a million times each; other times: tests/fuzz.sh MINUTES.
fuzz: setup
	tests/fuzz.sh

## All tests, with cases of the property tests that were never tried before.
properties: PACKAGES += $(TEST_PACKAGES)
properties: setup
	cargo test --release --workspace

## What takes long: oracles, benchmarks, kills and new cases. docs/check-long.txt says when all of it passed, and of which commit.
check-long:
	tests/check_long.sh

## The program without windows, wheels and CUDA, which a C compiler is enough for.
headless: PACKAGES := gcc libc6-dev
headless: setup
	cargo build --release -p aeye --no-default-features

## What that program refuses, and in which words.
headless-test: headless
	cargo test --release -p aeye --no-default-features --test headless

# The whole workspace, so that demo, test and bench ask the same features of the dependencies.
build: setup
	cargo build --release --workspace --bins

setup:
	@missing=$$(for p in $(PACKAGES); do dpkg -s $$p >/dev/null 2>&1 || echo $$p; done); \
	if [ -n "$$missing" ]; then \
		echo "installing:" $$missing; \
		$(SUDO) apt-get update -qq && $(SUDO) apt-get install -y -qq --no-install-recommends $$missing; \
	fi

# Built in a folder of their own: they share nothing with the workspace. Without optimisation: they are built longer than they run.
tools:
	@for tool in $(TOOLS); do \
		cargo install --list | grep -qx "$${tool%@*} v$${tool#*@}:" || \
		env -u CARGO_TARGET_DIR nice cargo install --debug --locked "$$tool" || exit 1; \
	done
