#!/usr/bin/env bash
# Makes the README's pictures of the windows anew: real windows on a virtual display, as the tests
# drive them. Needs what `make test` installs.
set -euo pipefail
cd "$(dirname "$0")/.."
for test in drive::two_people_drive_intervene_label_and_go_on view::one_looks_at; do
	AEYE_SCREENSHOTS=$PWD/docs cargo test --release --workspace --test windows "$test"
done
