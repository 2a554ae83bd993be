"""Make a small picture of a large one: python small.py LARGE SMALL [WIDTH]"""

import sys

from PIL import Image

image = Image.open(sys.argv[1]).convert("RGB")
width = int(sys.argv[3]) if len(sys.argv) > 3 else 640
image = image.resize((width, round(image.height * width / image.width)), Image.Resampling.LANCZOS)
colours = image.quantize(256, Image.Quantize.MAXCOVERAGE, kmeans=3, dither=Image.Dither.NONE)
colours.save(sys.argv[2], optimize=True)
