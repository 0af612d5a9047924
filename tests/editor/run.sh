#!/usr/bin/env bash
# What VS Code makes of a style: its own language server for JSON, on the schema that a style names.
# Needs Node 18 or later and npm; run by hand after a change of the schema.
set -euo pipefail
cd "$(dirname "$0")/../.."

cargo build --quiet
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp tests/editor/check.mjs "$folder"
(cd "$folder" && npm install --silent --no-save --no-audit --no-fund vscode-json-languageservice@5 >/dev/null)
node "$folder/check.mjs" "$PWD" "${CARGO_TARGET_DIR:-$PWD/target}/debug/restyle" "$folder"
