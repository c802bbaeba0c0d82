"""Writes a label into a picture."""

from PIL import Image, ImageDraw, ImageFont

FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"


def label(image: Image.Image, x: int, bottom: int, text: str, size: int) -> None:
    """Writes white text on a dark ground, at the lower left corner (x, bottom) of a part."""
    draw = ImageDraw.Draw(image, "RGBA")
    font = ImageFont.truetype(FONT, size)
    at = (x + size * 2 // 3, bottom - 2 * size)
    left, top, right, low = draw.textbbox(at, text, font=font)
    edge = size // 3
    draw.rectangle((left - edge, top - edge, right + edge, low + edge), fill=(0, 0, 0, 160))
    draw.text(at, text, font=font, fill="white")
