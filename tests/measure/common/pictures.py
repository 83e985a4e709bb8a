"""SVG pictures."""
from tactus.refusal import Refusal, sentence_of


class Picture:
    """Keyword arguments of all methods become SVG attributes: stroke_width=2 is stroke-width="2". Coordinates are in pixels, y down."""

    def __init__(self, width, height, font_size=11):
        self.parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="{font_size}">']
        self.add("rect", width="100%", height="100%", fill="white")

    def add(self, tag, content=None, **attributes):
        words = " ".join([tag, *(f'{name.replace("_", "-")}="{number(value)}"' for name, value in attributes.items() if value is not None)])
        self.parts.append(f"<{words}/>" if content is None else f"<{words}>{content}</{tag}>")

    def text(self, x, y, words, anchor=None, colour=None, bold=False, **more):
        self.add("text", words, x=x, y=y, text_anchor=anchor, fill=colour, font_weight="bold" if bold else None, **more)

    def line(self, x1, y1, x2, y2, colour="#ddd", **more):
        self.add("line", x1=x1, y1=y1, x2=x2, y2=y2, stroke=colour, **more)

    def curve(self, points, colour, width=1.5, **more):
        self.add("polyline", points=" ".join(f"{x:.1f},{y:.1f}" for x, y in points), fill="none", stroke=colour, stroke_width=width, **more)

    def box(self, x, y, width, height, fill="none", **more):
        self.add("rect", x=x, y=y, width=width, height=height, fill=fill, **more)

    def circle(self, x, y, radius, fill="none", stroke=None):
        self.add("circle", cx=x, cy=y, r=radius, fill=fill, stroke=stroke)

    def write(self, path):
        """Raises Refusal."""
        try:
            with open(path, "w", encoding="utf-8") as file:
                file.write("\n".join([*self.parts, "</svg>"]) + "\n")
        except OSError as error:
            raise Refusal(f"cannot write {sentence_of(error)}; name another file") from error


def number(value):
    """Numbers with at most one decimal."""
    return f"{value:.1f}".removesuffix(".0") if isinstance(value, (int, float)) else value
