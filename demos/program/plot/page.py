"""Pieces of the report's HTML page: tables, figures, and the page around them."""

import base64
import os
import re
from html import escape

from words import scheme_colour, scheme_label

_STYLE = """
:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.2rem clamp(0.8rem, 3vw, 2rem) 3rem; max-width: 72rem;
  font: 1rem/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif;
  color: #1c2126; background: #fff; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0.4rem 0 0.6rem; }
h2 { font-size: 1.3rem; margin: 2.4rem 0 0.5rem; padding-top: 0.6rem;
  border-top: 2px solid #e3e7ea; }
h3 { font-size: 1.08rem; margin: 1.6rem 0 0.4rem; }
p, ul { max-width: 46rem; margin: 0.5rem 0; }
ul { padding-left: 1.3rem; }
.wide { overflow-x: auto; margin: 0.8rem 0; -webkit-overflow-scrolling: touch; }
table { border-collapse: collapse; font-size: 0.88rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.3rem 0.5rem; text-align: left; vertical-align: top;
  border-bottom: 1px solid #e3e7ea; }
td { white-space: nowrap; }
.n { text-align: right; }
th.n { min-width: 4rem; }
thead th { background: #f4f6f8; font-weight: 600; vertical-align: bottom; }
thead .group { text-align: center; border-left: 2px solid #fff; }
.scheme { display: inline-block; width: 0.7em; height: 0.7em; margin-right: 0.45em; }
.reference { display: block; color: #5d6770; font-size: 0.92em; }
figure { margin: 1.2rem 0 1.6rem; max-width: 900px; }
figure img { display: block; width: 100%; height: auto; min-width: 640px; }
figcaption { color: #414b54; font-size: 0.92rem; margin-top: 0.35rem; max-width: 46rem; }
@media print { figure img { min-width: 0; } figure, tr { break-inside: avoid; } }
"""
_TYPES = {".svg": "image/svg+xml", ".gif": "image/gif"}
_NUMBER = re.compile("–|[0-9./ -]+")


def scheme_cell(scheme):
    return (f'<span class="scheme" style="background:{scheme_colour(scheme)}"></span>'
            f"{scheme_label(scheme)} ")


def table(header, rows, note="", groups=()):
    """A table of ready-made HTML cells. Columns of numbers are aligned right.

    `note` is said above it. `groups` are pairs of a heading and how many columns it spans.
    """
    is_number = [all(_NUMBER.fullmatch(row[c].split("<")[0]) for row in rows)
                 for c in range(len(header))]

    number = ' class="n"'

    def line(cells, tag):
        return "<tr>" + "".join(f"<{tag}{number if right else ''}>{cell}</{tag}>"
                                for cell, right in zip(cells, is_number)) + "</tr>\n"

    spans = "".join(f'<th class="group" colspan="{count}">{text}</th>' for text, count in groups)
    return ((f"<p>{note}</p>\n" if note else "") + '<div class="wide"><table>\n<thead>'
            + (f"<tr>{spans}</tr>\n" if spans else "") + line(header, "th") + "</thead>\n<tbody>\n"
            + "".join(line(row, "td") for row in rows) + "</tbody></table></div>\n")


def figure(picture, folder):
    """A figure whose files are in `folder`; nothing without its file."""
    path = os.path.join(folder, picture.name + picture.suffix)
    if not os.path.exists(path):
        return ""
    with open(path, "rb") as file:  # as an image: ids of two drawings cannot clash
        data = base64.b64encode(file.read()).decode()
    return (f'<figure id="{picture.name}"><div class="wide"><img width="{picture.width}" '
            f'height="{picture.height}" alt="{escape(picture.title)}" '
            f'src="data:{_TYPES[picture.suffix]};base64,{data}"></div>'
            f"<figcaption>{escape(picture.caption)}</figcaption></figure>\n")


def page(title, body):
    """A whole page, with nothing from elsewhere."""
    return ('<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            f"<title>{escape(title)}</title>\n<style>{_STYLE}</style>\n</head>\n<body>\n{body}"
            "</body>\n</html>\n")
