#!/usr/bin/env bash
# The golden timeline of the bundled maps holds without optimisation and with every instruction this
# processor has. (`cargo test --release --workspace` has compared them in the release build.)
set -euo pipefail
cd "$(dirname "$0")/../.."
target=${CARGO_TARGET_DIR:-target}

echo "golden timeline, debug"
cargo test -p kernel --test golden --test stories
echo "golden timeline, release with -C target-cpu=native"
RUSTFLAGS="-C target-cpu=native" cargo test -p kernel --test golden --test stories --release --target-dir "$target/native"
