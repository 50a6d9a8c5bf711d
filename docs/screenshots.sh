#!/usr/bin/env bash
# Makes the README's pictures of the windows anew: real windows on a virtual display, as the tests
# drive them. Needs what `make test` installs.
set -euo pipefail
cd "$(dirname "$0")/.."
pictures=$(mktemp -d)
trap 'rm -rf "$pictures"' EXIT
for test in drive::two_people_drive_intervene_label_and_go_on view::one_looks_at; do
	AEYE_SCREENSHOTS=$pictures cargo test --release --workspace --test windows "$test"
done
cp "$pictures"/{drive,view}.png docs/
