#!/usr/bin/env bash
# make_script.sh OUTPUT ESBUILD OPTIONS FILE...: the files one after the other as one script without
# blanks. What would end an element of HTML or a section of XML is written so that it does not.
set -euo pipefail
output=$1 esbuild=$2 options=$3
shift 3
# shellcheck disable=SC2086
cat "$@" | "$esbuild" --minify --target=es2018 --charset=ascii $options |
  sed -e 's/]]>/]] >/g' -e 's,</script,<\\/script,g' >"$output.part"
mv "$output.part" "$output"
