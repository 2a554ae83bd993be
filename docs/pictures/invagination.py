"""Make the README's picture from the tube.png of a run: python invagination.py tube.png invagination.png

Arranges the four panels two by two, without the third of the tube at the ileum end.
"""

import sys

from PIL import Image

page = Image.open(sys.argv[1]).convert("RGB")
width, height = page.size

# A panel begins where ink follows twelve white rows. The title precedes the first panel, the colour bar
# follows the last.
rows = page.convert("L").load()
inked = [any(rows[x, y] < 200 for x in range(width)) for y in range(height)]
begins = [y for y in range(12, height) if inked[y] and not any(inked[y - 12 : y])]
begins = begins if len(begins) > 5 else sys.exit("a picture of four panels is needed")
tops, bar = begins[-6:-2], begins[-2]

wide, high = round(0.717 * width), max(b - a for a, b in zip(tops, tops[1:] + [bar]))
sheet = Image.new("RGB", (2 * wide, 2 * high + height - bar), "white")
for i, (top, bottom) in enumerate(zip(tops, tops[1:] + [bar])):
    panel = page.crop((width // 90, top - 8, width // 90 + wide, bottom - 8))
    sheet.paste(panel, (i % 2 * wide, i // 2 * high))
sheet.paste(page.crop((width // 15, bar, width - width // 18, height)), (wide // 2, 2 * high))

size = (980, round(980 * sheet.height / sheet.width))
sheet.resize(size, Image.Resampling.LANCZOS).save(sys.argv[2], optimize=True)
