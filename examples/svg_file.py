"""A few lines to draw with, for the examples: curves and points in a frame, as SVG, and pictures as PNG.

SPDX-License-Identifier: MIT
"""
import struct
import zlib

import numpy as np

COLOURS = ["#3b6fd4", "#d4703b", "#2f9e6e", "#a04ec0", "#808080"]


def curves(path, x, ys, labels, title, y_high, x_name):
    """One curve for each row of ys, over [x[0], x[-1]] x [0, y_high]."""
    left, top, width, height = 46, 30, 420, 240
    shapes = [f'<rect x="{left}" y="{top}" width="{width}" height="{height}" fill="none" stroke="#999"/>',
              f'<text x="{left}" y="20">{title}</text>',
              f'<text x="{left + width / 2}" y="{top + height + 30}" text-anchor="middle">{x_name}</text>']
    for share in (0, 0.5, 1):
        shapes.append(f'<text x="{left - 5}" y="{top + height * (1 - share) + 4:.0f}" text-anchor="end">{y_high * share:g}</text>')
        at = x[0] + share * (x[-1] - x[0])
        shapes.append(f'<text x="{left + width * share:.0f}" y="{top + height + 15}" text-anchor="middle">{at:.3g}</text>')
    for k, (y, label) in enumerate(zip(ys, labels)):
        px = left + width * (x - x[0]) / (x[-1] - x[0])
        py = top + height * (1 - np.clip(y / y_high, 0, 1))
        line = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(px, py))
        shapes.append(f'<polyline points="{line}" fill="none" stroke="{COLOURS[k % 5]}" stroke-width="1.6"/>')
        shapes.append(f'<text x="{left + width + 8}" y="{top + 14 + 18 * k}" fill="{COLOURS[k % 5]}">{label}</text>')
    with open(path, "w", encoding="utf-8") as stream:
        stream.write('<svg xmlns="http://www.w3.org/2000/svg" width="660" height="310" font-family="sans-serif" font-size="12">'
                     f'<rect width="100%" height="100%" fill="#fff"/>{"".join(shapes)}</svg>\n')


def png(path, radiance):
    """Linear radiance, (height, width, 3), through the sRGB curve."""
    v = np.clip(radiance, 0, 1)
    v = np.where(v < 0.0031308, 12.92 * v, 1.055 * v ** (1 / 2.4) - 0.055)
    rows = np.round(255 * v).astype(np.uint8)
    height, width = rows.shape[:2]
    data = b"".join(b"\0" + rows[k].tobytes() for k in range(height))

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    with open(path, "wb") as stream:
        stream.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(data, 9)) + chunk(b"IEND", b""))
