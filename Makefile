# demo and test install what they need on Debian (apt; sudo only where you are not root).

PACKAGES := gcc libc6-dev pkg-config libudev-dev libvulkan1 mesa-vulkan-drivers \
	libxkbcommon-x11-0 libxcursor1 libxi6 libxrandr2 libx11-xcb1
TEST_PACKAGES := xvfb xdotool
SUDO := $(shell [ "$$(id -u)" = 0 ] || echo sudo)
AEYE := $(or $(CARGO_TARGET_DIR),target)/release/aeye

.PHONY: demo test bench oracles headless setup build

## Drives the bundled maps until three corner cases have happened and reports on them.
demo: build
	$(AEYE) demo --out out/demo

## Everything that CI runs.
test: PACKAGES += $(TEST_PACKAGES)
test: setup
	cargo fmt --all --check
	cargo clippy --release --workspace --all-targets -- -D warnings
	cargo clippy --release -p aeye --no-default-features --all-targets -- -D warnings
	cargo test --release --workspace
	kernel/tests/portable.sh

## Benchmarks; fails when a budget is broken.
bench: setup
	cargo bench --workspace --bench budgets

## Compares what is computed here with what programs of others make of the same files (Python, PyPI).
oracles: PACKAGES += python3-venv
oracles: build
	tests/oracles/run.sh $(AEYE) $(dir $(AEYE))../oracles

## The program without windows, wheels and CUDA, which a C compiler is enough for.
headless: PACKAGES := gcc libc6-dev
headless: setup
	cargo build --release -p aeye --no-default-features

# The whole workspace, so that demo, test and bench ask the same features of the dependencies.
build: setup
	cargo build --release --workspace --bins

setup:
	@missing=$$(for p in $(PACKAGES); do dpkg -s $$p >/dev/null 2>&1 || echo $$p; done); \
	if [ -n "$$missing" ]; then \
		echo "installing:" $$missing; \
		$(SUDO) apt-get update -qq && $(SUDO) apt-get install -y -qq --no-install-recommends $$missing; \
	fi
