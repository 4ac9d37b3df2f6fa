"""Rate-distortion curves as SVG: both axes logarithmic, nothing but markup that browsers draw by themselves."""
import dataclasses
import html
import math

# Told apart also by those who do not see red and green alike; dashes tell Reeb's configurations from one another.
LOOK = {"reeb": ("#0072b2", ""), "reeb-reorder": ("#0072b2", "2 3"), "reeb-fast": ("#56b4e9", ""),
        "reeb-thesis": ("#7b61c4", "7 4"), "reeb-bounded": ("#222222", "2 3"), "pca": ("#d55e00", ""),
        "draco": ("#009e73", ""),
        "meshopt": ("#e69f00", ""), "zfp": ("#cc79a7", "")}
OTHER = ("#888888", "4 3")


@dataclasses.dataclass(frozen=True)
class Curve:
    name: str  # of the configuration
    words: str  # for people
    points: list  # (x, y, what to say of it)


class Axis:
    """Logarithmic, from `low` to `high` over the pixels from `first` to `last`."""

    def __init__(self, values, first, last):
        self.low, self.high = min(values) / 1.2, max(values) * 1.2
        self.first, self.last = first, last

    def place(self, value):
        return self.first + (self.last - self.first) * math.log(value / self.low) / math.log(self.high / self.low)

    def ticks(self):
        """1, 2, 5 of each power of ten, powers of ten alone over long ranges."""
        digits = (1,) if self.high / self.low > 300 else (1, 2, 5)
        powers = range(math.floor(math.log10(self.low)), math.ceil(math.log10(self.high)) + 1)
        return [d * 10.0**p for p in powers for d in digits if self.low <= d * 10.0**p <= self.high]


def label(value):
    return f"{value:g}" if value >= 1e-4 else f"{value:.0e}"


def look(name):
    colour, dash = LOOK.get(name, OTHER)
    return f'stroke="{colour}"' + (f' stroke-dasharray="{dash}"' if dash else "")


def panel(curves, left, top, width, height, title="", x_label="", y_label=""):
    """One plot as an SVG group; empty where no curve has a point."""
    curves = [dataclasses.replace(c, points=sorted(p for p in c.points if p[0] > 0 and p[1] > 0)) for c in curves]
    points = [p for c in curves for p in c.points]
    if not points:
        return ""
    x = Axis([p[0] for p in points], left + 44, left + width - 8)
    y = Axis([p[1] for p in points], top + height - 34, top + 24)
    parts = [_grid(x, y), f'<text class="title" x="{x.first}" y="{top + 14}">{html.escape(title)}</text>',
             f'<text x="{(x.first + x.last) / 2:.0f}" y="{top + height - 4}" text-anchor="middle">{x_label}</text>']
    if y_label:
        middle = f"{left + 10} {(y.first + y.last) / 2:.0f}"
        parts.append(f'<text transform="translate({middle}) rotate(-90)" text-anchor="middle">{y_label}</text>')
    parts += [_drawn(curve, x, y) for curve in reversed(curves)]  # the first one on top
    return "".join(parts)


def _grid(x, y):
    parts = []
    for value in x.ticks():
        at = f"{x.place(value):.1f}"
        parts.append(f'<path class="grid" d="M{at} {y.first}V{y.last}"/>'
                     f'<text x="{at}" y="{y.first + 14}" text-anchor="middle">{label(value)}</text>')
    for value in y.ticks():
        at = f"{y.place(value):.1f}"
        parts.append(f'<path class="grid" d="M{x.first} {at}H{x.last}"/>'
                     f'<text x="{x.first - 5}" y="{float(at) + 4:.1f}" text-anchor="end">{label(value)}</text>')
    return "".join(parts)


def _drawn(curve, x, y):
    places = [(f"{x.place(p[0]):.1f}", f"{y.place(p[1]):.1f}", p[2]) for p in curve.points]
    line = "M" + "L".join(f"{px} {py}" for px, py, _ in places) if places else ""
    colour = LOOK.get(curve.name, OTHER)[0]
    dots = "".join(f'<circle cx="{px}" cy="{py}" r="2.6" fill="{colour}"><title>{html.escape(say)}</title></circle>'
                   for px, py, say in places)
    width = 2.4 if curve.name == "reeb" else 1.6
    return (f'<g class="curve" data-name="{curve.name}"><path d="{line}" fill="none" {look(curve.name)} '
            f'stroke-width="{width}"/>{dots}</g>')


STYLE = ("text{font:11px system-ui,sans-serif;fill:#555}.title{font-weight:600;font-size:13px;fill:#222}"
         ".grid{stroke:#ddd;stroke-width:1}")


def sheet(panels, columns=4, width=300, height=240):
    """Several plots with one legend, as a file of its own. `panels`: (title, curves) pairs."""
    rows = math.ceil(len(panels) / columns)
    full_width, full_height = columns * width, rows * height + 64
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {full_width} {full_height}" width="{full_width}" '
             f'height="{full_height}"><style>{STYLE}</style><rect width="100%" height="100%" fill="white"/>']
    for i, (title, drawn) in enumerate(panels):
        parts.append(panel(drawn, i % columns * width, i // columns * height + 4, width, height - 8, title,
                           "bits per vertex and frame", "" if i % columns else "KG error, percent"))
    parts.append(f'<text class="title" x="10" y="{full_height - 40}">Further down and to the left is better: less error '
                 'in fewer bits.</text>')
    return "".join(parts) + _legend(panels, 10, full_height - 16) + "</svg>\n"


def _legend(panels, left, y):
    """One line that names every curve of all plots, as listed in LOOK."""
    words = {curve.name: curve.words for _, curves in panels for curve in curves}
    parts = []
    for name in sorted(words, key=list(LOOK).index):
        parts.append(f'<path d="M{left:.0f} {y}h20" {look(name)} stroke-width="2.4"/>'
                     f'<text x="{left + 25:.0f}" y="{y + 4}">{html.escape(words[name])}</text>')
        left += 45 + 5.6 * len(words[name])
    return "".join(parts)
