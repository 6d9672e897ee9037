#include <algorithm>
#include <vector>

#include "tandem/plugin/toml_text.h"

namespace tandem {
namespace {

/// Follows a TOML text as a parser does: keys, brackets, strings and comments; values do not count.
class NestingScanner {
 public:
  explicit NestingScanner(std::string_view text) : text_(text) {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;  // byte order mark
  }

  std::optional<int> findDeeper(int most) {
    while (at_ < text_.size()) {
      take();
      if (base_ + parts_ > most) return line_;
    }
    return {};
  }

 private:
  /// Levels outside of an open bracket.
  struct Outside {
    bool is_table;
    int base, parts;
  };

  void take() {
    switch (text_[at_]) {
      case '\n':
        endLine();
        break;
      case '#':
        skipTo('\n');
        return;
      case '"':
      case '\'':
        startPart();
        skipString(text_[at_]);
        return;
      case '[':
        open(false);
        break;
      case '{':
        open(true);
        break;
      case ']':
      case '}':
        close();
        break;
      case ',':
        startKeyInTable();
        break;
      case '=':
        is_key_ = false;
        break;
      case '.':
        parts_ += is_key_ ? 1 : 0;
        break;
      case ' ':
      case '\t':
      case '\r':
        break;
      default:
        startPart();
    }
    ++at_;
  }

  void endLine() {
    ++line_;
    if (!outside_.empty()) return;
    base_ = header_;
    parts_ = 0;
    is_key_ = true;
    is_header_ = false;
  }

  /// The first character of a key counts the first part; its dots count the others.
  void startPart() {
    if (is_key_) parts_ = std::max(parts_, 1);
  }

  void startKeyInTable() {
    if (outside_.empty() || !outside_.back().is_table) return;
    is_key_ = true;
    parts_ = 0;
  }

  void open(bool is_table) {
    if (is_key_) {  // brackets do not begin a key, but a line's first one begins a header
      if (!is_table && outside_.empty() && parts_ == 0) openHeader();
      return;
    }
    outside_.push_back({is_table, base_, parts_});
    base_ += parts_ + (is_table ? 0 : 1);
    parts_ = 0;
    is_key_ = is_table;
  }

  void openHeader() {
    base_ = is_header_ ? 1 : 0;  // a second bracket: an array of tables
    is_header_ = true;
  }

  void close() {
    if (is_header_ && is_key_) {
      header_ = base_ + parts_;
    } else if (!outside_.empty()) {
      base_ = outside_.back().base;
      parts_ = outside_.back().parts;
      outside_.pop_back();
    }
    is_key_ = false;
  }

  void skipTo(char end) { at_ = std::min(text_.find(end, at_), text_.size()); }

  /// Steps over a string in one pair of quotes, which ends with its line, or in three.
  void skipString(char quote) {
    const bool has_escapes = quote == '"';
    const bool is_long =
        at_ + 2 < text_.size() && text_[at_ + 1] == quote && text_[at_ + 2] == quote;
    at_ += is_long ? 3 : 1;
    for (int quotes = 0; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n' && !is_long) return;
      if (c == '\n') ++line_;
      // Up to two quotes may stand before the three that end a long string.
      if (is_long && quotes >= 3 && (c != quote || quotes == 5)) return;
      quotes = c == quote ? quotes + 1 : 0;
      if (c == quote && !is_long) {
        ++at_;
        return;
      }
      if (c == '\\' && has_escapes && at_ + 1 < text_.size() && text_[at_ + 1] != '\n') ++at_;
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
  int header_ = 0;  ///< levels of the last header
  int base_ = 0;    ///< levels around the current key or value
  int parts_ = 0;   ///< levels of the current key
  bool is_key_ = true, is_header_ = false;
  std::vector<Outside> outside_;  ///< of each open bracket of a value
};

}  // namespace

std::optional<int> findDeepToml(std::string_view text, int most) {
  return NestingScanner(text).findDeeper(most);
}

}  // namespace tandem
