#!/usr/bin/env bash
# Makes the picture strips of hazards.md anew: drives each scenario of docs/hazards, finds the moment that shows its
# hazard best, and draws it. Names of hazards (cut-ins ...) make only theirs. Needs a Vulkan driver, as all that draws.
set -euo pipefail
cd "$(dirname "$0")/.."
pictures=$(mktemp -d)
trap 'rm -rf "$pictures"' EXIT
cargo build --release --workspace --example hazard_strips
target=$(cargo metadata --no-deps --format-version 1 | sed 's/.*"target_directory":"\([^"]*\)".*/\1/')
"$target/release/examples/hazard_strips" docs/hazards "$pictures" "$@"
if find "$pictures" -name '*.png' -size +60k | grep .; then
	echo "larger than 60 kB" >&2
	exit 1
fi
cp "$pictures"/*.png docs/hazards/
