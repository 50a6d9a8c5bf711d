#!/usr/bin/env bash
# The golden timeline of the bundled maps holds without optimisation of ours, with that of the libraries for every instruction
# this processor has. (`cargo test --release --workspace` has compared it in the release build; other builds: make matrix.)
set -euo pipefail
cd "$(dirname "$0")/../.."
target=${CARGO_TARGET_DIR:-target}

RUSTFLAGS="-C target-cpu=native" cargo test -p kernel --test golden --test stories --target-dir "$target/native"
