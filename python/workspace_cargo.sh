#!/usr/bin/env bash
# Stands in for cargo while maturin builds (as CARGO). maturin builds this crate alone, of whose dependencies cargo would then
# make a second set, since the workspace as a whole asks them for more features. This builds all libraries of the workspace
# instead; what maturin looks for is among them. Nor does pyo3 hear of an interpreter, which is all the same to abi3, so that it
# is built as it is without maturin.
set -euo pipefail

[ "${1:-}" = rustc ] || exec cargo "$@"
shift
arguments=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
	case $1 in
	--lib) ;;
	*) arguments+=("$1") ;;
	esac
	shift
done
unset PYO3_BUILD_EXTENSION_MODULE PYO3_CONFIG_FILE PYO3_ENVIRONMENT_SIGNATURE PYO3_PYTHON PYTHON_SYS_EXECUTABLE
exec cargo build --workspace --lib "${arguments[@]}"
