"""Pieces of the report's HTML page: tables, figures, and the page around them."""

import base64
import os
import re
from html import escape

from canvas import WIDTH
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
figure img, figure svg { display: block; width: 100%; height: auto; min-width: 640px; }
figcaption { color: #414b54; font-size: 0.92rem; margin-top: 0.35rem; max-width: 46rem; }
button { font: inherit; padding: 0.2rem 0.9rem; border: 1px solid #9aa4ad; border-radius: 0.3rem;
  background: #f4f6f8; cursor: pointer; }
@media print { figure img, figure svg { min-width: 0; } figure, tr { break-inside: avoid; }
  button { display: none; } }
"""
_PAUSE = ("const s=this.parentNode.querySelector('svg');if(s.animationsPaused())"
          "{s.unpauseAnimations();this.textContent='Pause';}"
          "else{s.pauseAnimations();this.textContent='Play';}")
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
    """A figure whose files are in `folder`. Moving pictures get a button that stops them."""
    if picture.svg:
        inside = (f'<div class="wide">{picture.svg}</div>'
                  f'<button type="button" onclick="{_PAUSE}">Pause</button>')
    else:  # as an image: ids of two drawings cannot clash
        with open(os.path.join(folder, f"{picture.name}.svg"), "rb") as file:
            data = base64.b64encode(file.read()).decode()
        inside = (f'<div class="wide"><img width="{WIDTH}" height="{picture.height}" '
                  f'alt="{escape(picture.title)}" src="data:image/svg+xml;base64,{data}"></div>')
    return (f'<figure id="{picture.name}">{inside}<figcaption>{escape(picture.caption)}'
            "</figcaption></figure>\n")


def page(title, body):
    """A whole page, with nothing from elsewhere."""
    return ('<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            f"<title>{escape(title)}</title>\n<style>{_STYLE}</style>\n</head>\n<body>\n{body}"
            "</body>\n</html>\n")
