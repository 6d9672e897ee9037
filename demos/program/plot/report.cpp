#include "plot/report.h"

#include <fmt/format.h>

#include "plot/table.h"

namespace tandem::demos::plot {
namespace {

// Drawings by gnuplot go in as images: their ids cannot clash with each other.
std::string imageHtml(const Figure& figure, const std::filesystem::path& folder) {
  return fmt::format(
      "<div class=\"wide\"><img width=\"{}\" height=\"{}\" alt=\"{}\" "
      "src=\"data:image/svg+xml;base64,{}\"></div>",
      figure.width, figure.height, escapeHtml(figure.title),
      encodeBase64(readText(folder / (figure.name + ".svg"))));
}

// Moving pictures go in as they are, with a button that stops them.
std::string movingHtml(const Figure& figure) {
  return fmt::format(
      "<div class=\"wide\">{}</div><button type=\"button\" onclick=\"const s="
      "this.parentNode.querySelector('svg');if(s.animationsPaused()){{s.unpauseAnimations();"
      "this.textContent='Pause';}}else{{s.pauseAnimations();this.textContent='Play';}}\">Pause"
      "</button>",
      figure.svg);
}

std::string figureHtml(const Figure& figure, const std::filesystem::path& folder) {
  return fmt::format("<figure id=\"{}\">{}<figcaption>{}</figcaption></figure>\n", figure.name,
                     figure.svg.empty() ? imageHtml(figure, folder) : movingHtml(figure),
                     escapeHtml(figure.caption));
}

}  // namespace

Report::Report(std::string title) : title_(std::move(title)) { addHeading(1, title_); }

void Report::addHeading(int level, const std::string& text) {
  blocks_.push_back({fmt::format("<h{0}>{1}</h{0}>\n", level, escapeHtml(text)), std::nullopt});
}

void Report::addParagraph(const std::string& html) {
  blocks_.push_back({fmt::format("<p>{}</p>\n", html), std::nullopt});
}

void Report::addList(const std::vector<std::string>& html_items) {
  if (html_items.empty()) return;
  std::string html = "<ul>\n";
  for (const std::string& item : html_items) html += fmt::format("<li>{}</li>\n", item);
  blocks_.push_back({html + "</ul>\n", std::nullopt});
}

void Report::addTable(const HtmlTable& table) { blocks_.push_back({table.toHtml(), std::nullopt}); }

void Report::addFigure(Figure figure) { blocks_.push_back({"", std::move(figure)}); }

std::vector<const Figure*> Report::figures() const {
  std::vector<const Figure*> figures;
  for (const Block& block : blocks_)
    if (block.figure) figures.push_back(&*block.figure);
  return figures;
}

std::string Report::toHtml(const std::filesystem::path& folder) const {
  std::string body;
  for (const Block& block : blocks_)
    body += block.figure ? figureHtml(*block.figure, folder) : block.html;
  return htmlPage(title_, body);
}

}  // namespace tandem::demos::plot
