#!/bin/sh
# Makes a library that replaces one that the archive leaves out. It has all symbols that other libraries need from the
# original, because the loader requires them. Its functions do nothing and return 0; its data are 0.
#
# stand_in.sh LIBRARY OUTPUT USER...   USER: libraries of the archive, which may need LIBRARY
set -eu
library=$1 output=$2
shift 2
export LC_ALL=C

# Writes a line "name version kind bytes" for each symbol that LIBRARY defines and a USER needs; version - if there is
# none.
{
  nm -D --undefined-only --with-symbol-versions "$@" | awk '{ sub(/@+/, "@", $NF); print "asked", $NF }'
  nm -D -S --defined-only --with-symbol-versions "$library" | awk '
    { name = version = $NF; sub(/@.*/, "", name)
      if (!sub(/.*@/, "", version)) version = "-"
      print "has", name, version, $(NF - 1), (NF > 3 ? $2 : 0) }'
} | awk '$1 == "asked" { asked[$2]; next }
         ($2 in asked || $2 "@" $3 in asked) && !seen[$2]++ { print $2, $3, $4, $5 }' >"$output.symbols"

awk '{
    data = $3 ~ /[BDRVGSCu]/
    printf "%s\n.globl %s\n.type %s, @%s\n", data ? ".data\n.balign 32" : ".text", $1, $1, data ? "object" : "function"
    if (data) printf ".size %s, 0x%s\n%s: .zero 0x%s\n", $1, $4, $1, $4
    else printf "%s: xorl %%eax, %%eax\nret\n", $1
  }
  END { print ".section .note.GNU-stack,\"\",@progbits" }' "$output.symbols" >"$output.s"
awk '$2 != "-" { names[$2] = names[$2] " " $1 ";" }
  END { for (version in names) printf "%s {%s };\n", version, names[version] }' "$output.symbols" >"$output.map"

soname=$(readelf -dW "$library" | sed -n 's/.*(SONAME).*\[\(.*\)\]/\1/p')
${CC:-cc} -shared -nostdlib -Wl,--soname="$soname" $([ ! -s "$output.map" ] || echo "-Wl,--version-script=$output.map") \
  -o "$output" "$output.s"
strip "$output"
rm "$output.symbols" "$output.s" "$output.map"
