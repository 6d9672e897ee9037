#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tandem::pybullet {

/// Parses a command: a name, then words `key=value` separated by spaces. A value with spaces stands
/// in double quotes. Numbers are decimal; commas separate several numbers. Throws
/// Refusal(kBadCommand) if it cannot be parsed.
class Words {
 public:
  explicit Words(std::string_view line);

  const std::string& name() const { return name_; }
  bool has(std::string_view key) const;

  // Each reads the word of a key, and marks it as known.
  std::string text(std::string_view key);
  std::string text(std::string_view key, std::string_view otherwise);
  double number(std::string_view key);
  double number(std::string_view key, double otherwise);
  int integer(std::string_view key);
  int integer(std::string_view key, int otherwise);
  /// Number of a user, from 1.
  std::uint32_t id(std::string_view key);
  std::uint64_t count(std::string_view key, std::uint64_t otherwise);
  /// The value is 0 or 1.
  bool flag(std::string_view key, bool otherwise);
  /// Reads `size` finite numbers into `out`.
  void numbers(std::string_view key, double* out, std::size_t size);
  bool numbersIfThere(std::string_view key, double* out, std::size_t size);

  /// Throws if the command has not read every word.
  void finish() const;

 private:
  struct Word {
    std::string key, value;
    bool is_known = false;
  };
  Word* find(std::string_view key);
  Word& get(std::string_view key);

  std::string name_;
  std::vector<Word> words_;
};

}  // namespace tandem::pybullet
