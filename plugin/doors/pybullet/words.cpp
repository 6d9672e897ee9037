#include "words.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "refusal.h"

namespace tandem::pybullet {
namespace {

[[noreturn]] void refuse(const std::string& text) { throw Refusal(kBadCommand, text); }

/// Cuts the next word off a line. Double quotes keep spaces in a word and are dropped.
std::string cutWord(std::string_view& line) {
  std::string word;
  bool is_quoted = false;
  std::size_t at = 0;
  for (; at < line.size() && (is_quoted || line[at] != ' '); ++at) {
    if (line[at] == '"') {
      is_quoted = !is_quoted;
    } else if (static_cast<unsigned char>(line[at]) < 0x20) {
      refuse("a command is one line of text, without control characters");
    } else {
      word.push_back(line[at]);
    }
  }
  if (is_quoted) refuse("a double quote is missing at the end of: " + word);
  line.remove_prefix(at);
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  return word;
}

template <typename Number>
Number read(const std::string& key, std::string_view value) {
  Number number{};
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc() || end != value.data() + value.size()) {
    refuse(key + "=" + std::string(value) + ": not a number that fits");
  }
  return number;
}

}  // namespace

Words::Words(std::string_view line) {
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  name_ = cutWord(line);
  while (!line.empty()) {
    const std::string word = cutWord(line);
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0) {
      refuse(name_ + ": " + word + ": words after the name are key=value");
    }
    Word next{word.substr(0, equals), word.substr(equals + 1)};
    if (has(next.key)) refuse(name_ + ": " + next.key + " is given twice");
    words_.push_back(std::move(next));
  }
}

Words::Word* Words::find(std::string_view key) {
  for (Word& word : words_) {
    if (word.key == key) {
      word.is_known = true;
      return &word;
    }
  }
  return nullptr;
}

Words::Word& Words::get(std::string_view key) {
  Word* const word = find(key);
  if (!word) refuse(name_ + ": " + std::string(key) + "=... is missing");
  return *word;
}

bool Words::has(std::string_view key) const {
  return std::any_of(words_.begin(), words_.end(), [&](const Word& w) { return w.key == key; });
}

std::string Words::text(std::string_view key) { return get(key).value; }

std::string Words::text(std::string_view key, std::string_view otherwise) {
  const Word* const word = find(key);
  return word ? word->value : std::string(otherwise);
}

double Words::number(std::string_view key) {
  const Word& word = get(key);
  return read<double>(word.key, word.value);
}

double Words::number(std::string_view key, double otherwise) {
  return has(key) ? number(key) : otherwise;
}

int Words::integer(std::string_view key) {
  const Word& word = get(key);
  return read<int>(word.key, word.value);
}

int Words::integer(std::string_view key, int otherwise) {
  return has(key) ? integer(key) : otherwise;
}

std::uint32_t Words::id(std::string_view key) {
  const int id = integer(key);
  if (id < 1) refuse(std::string(key) + ": 1 or more");
  return static_cast<std::uint32_t>(id);
}

std::uint64_t Words::count(std::string_view key, std::uint64_t otherwise) {
  const Word* const word = find(key);
  return word ? read<std::uint64_t>(word->key, word->value) : otherwise;
}

bool Words::flag(std::string_view key, bool otherwise) {
  const int value = integer(key, otherwise ? 1 : 0);
  if (value != 0 && value != 1) refuse(std::string(key) + ": 0 or 1");
  return value == 1;
}

void Words::numbers(std::string_view key, double* out, std::size_t size) {
  const Word& word = get(key);
  std::string_view rest = word.value;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t comma = rest.find(',');
    if ((comma == std::string_view::npos) != (i + 1 == size)) {
      refuse(word.key + "=" + word.value + ": " + std::to_string(size) +
             " numbers with commas between");
    }
    const double value = read<double>(word.key, rest.substr(0, comma));
    if (!std::isfinite(value)) refuse(word.key + "=" + word.value + ": must be finite");
    out[i] = value;
    rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
  }
}

bool Words::numbersIfThere(std::string_view key, double* out, std::size_t size) {
  if (!has(key)) return false;
  numbers(key, out, size);
  return true;
}

void Words::finish() const {
  for (const Word& word : words_) {
    if (!word.is_known) refuse(name_ + ": it has no word " + word.key);
  }
}

}  // namespace tandem::pybullet
