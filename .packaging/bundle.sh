#!/bin/sh
# Makes weft-x86_64.tar.zst: the program with all its libraries, also its loader and the C library, so that it runs on
# any Linux system and from any folder. `ninja bundle` calls this script.
#
# bundle.sh BUILD START OUTPUT [osmesa|egl]   START: program compiled from start.c. Last argument: source of OpenGL
#                                             (default: osmesa, or egl if it is absent). ZSTD_CLEVEL in the
#                                             environment: compression level (default: 19)
set -eu
build=$1 start=$2 output=$3 opengl=${4:-any}
PATH=$PATH:/usr/sbin:/sbin
export LC_ALL=C
umask 022
die() { echo "bundle: $*" >&2; exit 1; }
for tool in zstd tar ldd ldconfig strip; do
  command -v $tool >/dev/null || die "$tool is not found: apt-get install zstd tar libc-bin binutils"
done

mkdir -p "$output"
tree=$(mktemp -d "$output/.bundle.XXXXXX")
trap 'rm -rf "$tree"' EXIT
top=$tree/weft

# The programs are in libexec/. bin/ has a copy of START for each of them, which starts it with the loader and the
# libraries of lib/.
cmake --install "$build" --prefix "$top" --component program --strip >/dev/null
mkdir "$top/libexec" "$top/lib"
mv "$top"/bin/* "$top/libexec/"
for program in "$top"/libexec/*; do
  cp "$start" "$top/bin/${program##*/}"
done
strip "$top"/bin/*

# Prints the path of a library in this system. Argument: the name by which programs open it. Prints nothing if it is
# absent.
place_of() { ldconfig -p | awk -v name="$1" '$1 == name && /x86-64/ { print $NF; exit }'; }

# OpenGL libraries are opened at run time, so they are not among the libraries that programs name.
osmesa=$(place_of libOSMesa.so.8) egl=$(place_of libEGL.so.1) mesa=$(place_of libEGL_mesa.so.0)
case $opengl in
  any) [ -z "$osmesa" ] && opengl=egl || opengl=osmesa ;;
esac
case $opengl in
  osmesa) [ -n "$osmesa" ] || die "libOSMesa.so.8 is not found: apt-get install libosmesa6, or take egl"
    opened=$osmesa ;;
  egl) [ -n "$egl" ] && [ -n "$mesa" ] || die "no OpenGL is found: apt-get install libosmesa6, or libegl1 libgl1-mesa-dri"
    opened="$egl $mesa"
    # Before version 24.3, Mesa itself opens this driver. render/gl/context.cpp sets its path.
    driver=${mesa%/*}/dri/swrast_dri.so
    if [ -e "$driver" ]; then
      mkdir "$top/lib/dri"
      cp -L "$driver" "$top/lib/dri/"
      opened="$opened $driver"
    fi
    echo '{"file_format_version": "1.0.0", "ICD": {"library_path": "libEGL_mesa.so.0"}}' >"$top/lib/egl_vendor.json" ;;
  *) die "expected osmesa or egl, got $opengl" ;;
esac

# Whether a library is left out. libav needs many libraries for other codecs, protocols and devices, and LLVM for proofs
# and XML. `weft` never uses these, and they would be half of the archive. The libraries named here are not left out:
# x264, dav1d (AV1), basic libraries, and gme and openmpt, which libav calls for each file that it opens.
is_left_out() { # USER LIBRARY
  case $1 in
    libav* | libsw*)
      case $2 in
        libav* | libsw* | libx264.* | libdav1d.* | libgme.* | libopenmpt.*) false ;;
        libz.* | libbz2.* | liblzma.* | libm.* | libc.* | libgcc_s.* | libstdc++.* | ld-*) false ;;
      esac ;;
    libLLVM*) case $2 in libz3.* | libedit.* | libxml2.*) ;; *) false ;; esac ;;
    *) false ;;
  esac
}

# Finds all libraries that the programs need, directly or through other libraries.
# shellcheck disable=SC2086 # one word per library
ldd "$top"/libexec/* $opened >"$tree/places"
! grep 'not found' "$tree/places" >&2 || die "the program needs libraries that are not installed here"
: >"$tree/taken"
: >"$tree/left_out"
set -- "$top"/libexec/* $opened
for library in $opened; do
  case $library in */dri/*) ;; *) echo "$library" >>"$tree/taken" ;; esac
done
while [ $# -gt 0 ]; do
  user=$1
  shift
  for name in $(readelf -dW "$user" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p'); do
    place=$(awk -v name="$name" '$1 == name && $2 == "=>" { print $3; exit }' "$tree/places")
    case $name in ld-*) place=/lib64/$name ;; esac
    if is_left_out "${user##*/}" "$name"; then
      echo "$place" >>"$tree/left_out"
    elif ! grep -qxF "$place" "$tree/taken"; then
      echo "$place" >>"$tree/taken"
      set -- "$@" "$place"
    fi
  done
done
while read -r library; do
  cp -L "$library" "$top/lib/"
done <"$tree/taken"
sort -u "$tree/left_out" | grep -vxF -f "$tree/taken" | while read -r library; do
  "${0%/*}/stand_in.sh" "$library" "$tree/stand_in" "$top"/lib/*.so*
  mv "$tree/stand_in" "$top/lib/${library##*/}"
done

# Checks that the programs find all their libraries in the archive, and use none of this system.
for file in "$top"/libexec/* $opened; do
  case $file in
    */dri/*) file=$top/lib/dri/${file##*/} ;;
    /usr/* | /lib/*) file=$top/lib/${file##*/} ;;
  esac
  "$top/lib/ld-linux-x86-64.so.2" --inhibit-cache --library-path "$top/lib" --list "$file" >"$tree/found" 2>&1 ||
    die "${file##*/}: $(cat "$tree/found")"
  ! grep -vF -e "$top/lib/" -e linux-vdso -e 'statically linked' "$tree/found" >&2 || die "${file##*/}: needs what is not in the archive"
done
LD_BIND_NOW=1 "$top/bin/weft" doctor >"$tree/doctor" 2>&1 || die "the archive does not work: $(cat "$tree/doctor")"

# Lists the packages of the libraries with their versions, and copies their licenses.
if command -v dpkg-query >/dev/null; then
  mkdir -p "$top/share/doc/weft/licenses"
  xargs readlink -f <"$tree/taken" | sed 'p; s,^/usr,,' | xargs dpkg-query -S 2>/dev/null | sed 's/:.*//' | sort -u |
    while read -r package; do
      dpkg-query -W -f '${Package} ${Version}\n' "$package"
      cp -L "/usr/share/doc/$package/copyright" "$top/share/doc/weft/licenses/$package"
    done >"$top/share/doc/weft/packages.txt"
fi

# Equal files give an archive with equal bytes. The format ustar is readable by any tar.
archive=weft-x86_64.tar.zst
tar -C "$tree" --format=ustar --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner -cf - weft |
  zstd -q -f -T0 "-${ZSTD_CLEVEL:-19}" -o "$tree/$archive"
mv "$tree/$archive" "$output/$archive"
echo "$output/$archive: $(($(wc -c <"$output/$archive") / 1000000)) MB, unpacked $(du -sm "$top" | cut -f 1) MB, OpenGL from $opengl"
