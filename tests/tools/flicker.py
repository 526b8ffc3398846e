#!/usr/bin/env python3
"""Counts pixels of a still camera that flip: change by more than LEVELS in one frame and go back in the next.

Usage: flicker.py FRAME.png FRAME.png FRAME.png ... [--levels 6] [--map OUT.png]

Frames are PNG files with 8 bits per channel, in order, at least three. A pixel flips in frame k if one of its channels
differs from frame k - 1 and from frame k + 1 by more than `--levels`, both times in the same direction. Prints the
number of flips of each frame, their mean and maximum, and the largest deviation of the picture's corners, which show
the backdrop, from those of the first frame. `--map` writes a picture of the flips, brighter for more. Needs numpy."""
import argparse
import struct
import sys
import zlib

import numpy


def read_png(path):
    data = open(path, "rb").read()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        sys.exit(f"{path}: expected a PNG file")
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, bits, color = struct.unpack(">IIBB", body[:10])
        if kind == b"IDAT":
            packed += body
        at += length + 12
    channels = {0: 1, 2: 3, 6: 4}.get(color)
    if bits != 8 or channels is None:
        sys.exit(f"{path}: expected 8 bits a channel without a palette, got {bits} bits of kind {color}")
    rows = numpy.frombuffer(zlib.decompress(packed), numpy.uint8).reshape(height, 1 + width * channels)
    picture = numpy.zeros((height, width, channels), numpy.uint8)
    above = numpy.zeros((width, channels), numpy.int32)
    for y in range(height):
        kind, row = rows[y, 0], rows[y, 1:].reshape(width, channels).astype(numpy.int32)
        if kind == 1:  # left
            row = numpy.cumsum(row, axis=0) & 255
        elif kind == 2:  # up
            row = (row + above) & 255
        elif kind > 2:  # average, Paeth: pixel by pixel
            left = numpy.zeros(channels, numpy.int32)
            corner = numpy.zeros(channels, numpy.int32)
            for x in range(width):
                up = above[x]
                if kind == 3:
                    guess = (left + up) // 2
                else:
                    p = left + up - corner
                    a, b, c = abs(p - left), abs(p - up), abs(p - corner)
                    guess = numpy.where((a <= b) & (a <= c), left, numpy.where(b <= c, up, corner))
                corner = up
                row[x] = left = (row[x] + guess) & 255
        picture[y], above = row, row
    return picture[:, :, :3].astype(numpy.int16)


def write_png(path, grey):
    height, width = grey.shape
    raw = b"".join(b"\0" + row.tobytes() for row in grey.astype(numpy.uint8))
    chunk = lambda kind, body: struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))


def flips(before, here, after, levels):
    up = (here - before > levels) & (here - after > levels)
    down = (before - here > levels) & (after - here > levels)
    return (up | down).any(axis=2)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("frames", nargs="+")
    arguments.add_argument("--levels", type=int, default=6)
    arguments.add_argument("--map")
    options = arguments.parse_args()
    if len(options.frames) < 3:
        sys.exit(f"expected three frames or more, got {len(options.frames)}")
    pictures = [read_png(path) for path in options.frames[:2]]
    first, count, total, backdrop = pictures[0], [], numpy.zeros(pictures[0].shape[:2], int), 0
    corners = (slice(0, 8), slice(-8, None))
    for path in options.frames[2:]:
        pictures.append(read_png(path))
        flipped = flips(*pictures, options.levels)
        count.append(int(flipped.sum()))
        total += flipped
        for y in corners:
            for x in corners:
                backdrop = max(backdrop, abs(float(pictures[1][y, x].mean()) - float(first[y, x].mean())))
        pictures.pop(0)
    print("flips a frame:", *count)
    print(f"mean {sum(count) / len(count):.1f}, most {max(count)}, corners depart by {backdrop:.2f} levels")
    if options.map:
        write_png(options.map, numpy.clip(64 * total, 0, 255))


main()
