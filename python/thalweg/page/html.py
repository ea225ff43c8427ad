"""Pieces of a page that needs nothing else: no script, no network, pictures inside the text."""
import base64
import io
from html import escape

STYLE = """
:root { color: #1c2830; background: #fff; font: 16px/1.5 Charter, "Bitstream Charter", "Source Serif 4", Georgia, serif; }
body { max-width: 54rem; margin: 2.5rem auto 4rem; padding: 0 1.5rem; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0; }
h2 { font-size: 1.2rem; margin: 2.4rem 0 .6rem; padding-bottom: .2rem; border-bottom: 1px solid #c9d2d8; }
p { margin: .5rem 0; }
.lead { color: #4d5c66; margin: .3rem 0 1.2rem; }
.state { font-weight: 600; }
.finished { color: #1d6b46; } .unfinished { color: #9a5b00; }
table { border-collapse: collapse; font-size: .93rem; margin: .4rem 0; }
th, td { text-align: left; vertical-align: top; padding: .16rem 1.2rem .16rem 0; overflow-wrap: anywhere; }
th { font-weight: 600; color: #4d5c66; } td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
td:first-child { white-space: nowrap; }
tr + tr td { border-top: 1px solid #edf0f2; }
.bar { background: #a9cfe3; height: .7rem; display: block; }
td.wide { width: 40%; }
figure { margin: 1rem 0; } figure img { max-width: 100%; max-height: 34rem; display: block; }
figcaption { font-size: .9rem; color: #4d5c66; margin-top: .3rem; }
ul { padding-left: 1.2rem; } li { margin: .3rem 0; }
li.warning::marker { color: #b3541e; }
pre { font: .8rem/1.45 "DejaVu Sans Mono", Menlo, Consolas, monospace; background: #f5f7f8; padding: .8rem 1rem; margin: .5rem 0;
      white-space: pre-wrap; overflow-wrap: anywhere; }
footer { margin-top: 3rem; font-size: .85rem; color: #4d5c66; }
@media print {
  :root { font-size: 10.5pt; } body { max-width: none; margin: 0; padding: 0; }
  h2 { break-after: avoid; } figure, tr { break-inside: avoid; } pre { background: none; border: 1px solid #c9d2d8; }
  .bar { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
@page { margin: 18mm; }
"""


def table(rows, head=None, numbers=()):
    """rows: of texts, or of Raw; numbers: columns that stand to the right."""
    def cells(row, tag):
        return "".join(
            f"<{tag}{' class=number' if n in numbers else ''}>{piece(cell)}</{tag}>" for n, cell in enumerate(row)
        )
    lines = ([f"<thead><tr>{cells(head, 'th')}</tr></thead>"] if head else []) + ["<tbody>"]
    lines += [f"<tr>{cells(row, 'td')}</tr>" for row in rows]
    return "<table>" + "\n".join(lines) + "</tbody></table>"


class Raw(str):
    """HTML, as it is."""


def piece(text):
    return text if isinstance(text, Raw) else escape(str(text))


def paragraph(text, kind=""):
    attribute = f' class="{kind}"' if kind else ""
    return f"<p{attribute}>{piece(text)}</p>"


def listing(items, kind=""):
    attribute = f' class="{kind}"' if kind else ""
    return "<ul>" + "\n".join(f"<li{attribute}>{piece(item)}</li>" for item in items) + "</ul>"


def preformatted(text):
    return f"<pre>{escape(text)}</pre>"


def bar(share):
    """A bar as long as a share of the cell."""
    return Raw(f'<span class="bar" style="width: {100.0 * share:.3g}%"></span>')


def picture(figure, caption, dpi=130):
    """A matplotlib figure, as a .png inside the page."""
    import matplotlib.pyplot as plt
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=dpi)
    plt.close(figure)
    data = base64.b64encode(stream.getvalue()).decode()
    return (f'<figure><img alt="{escape(caption, quote=True)}" src="data:image/png;base64,{data}">'
            f"<figcaption>{escape(caption)}</figcaption></figure>")


def section(title, *parts):
    return f"<section>\n<h2>{escape(title)}</h2>\n" + "\n".join(parts) + "\n</section>"


def document(title, body):
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<meta name="viewport"'
        ' content="width=device-width">\n'
        f'<title>{escape(title)}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n{body}\n</body>\n</html>\n'
    )
