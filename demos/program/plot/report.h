#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "plot/figure.h"
#include "plot/html.h"

namespace tandem::demos::plot {

/// A report in reading order: pieces of HTML, and figures that are drawn before it is written.
class Report {
 public:
  explicit Report(std::string title);

  void addHeading(int level, const std::string& text);
  /// `html` is markup already.
  void addParagraph(const std::string& html);
  void addList(const std::vector<std::string>& html_items);
  void addTable(const HtmlTable& table);
  void addFigure(Figure figure);

  /// The figures in reading order.
  [[nodiscard]] std::vector<const Figure*> figures() const;

  /// The page with every figure in it; `folder` has the figures' SVG files.
  [[nodiscard]] std::string toHtml(const std::filesystem::path& folder) const;

 private:
  struct Block {
    std::string html;
    std::optional<Figure> figure;
  };

  std::string title_;
  std::vector<Block> blocks_;
};

}  // namespace tandem::demos::plot
