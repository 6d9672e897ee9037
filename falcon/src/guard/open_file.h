#pragma once

#include <utility>

#include <unistd.h>

namespace tandem::falcon_detail {

/// An open file that closes itself.
class OpenFile {
 public:
  /// Takes what ::open() returned; negative: no file.
  explicit OpenFile(int number) noexcept : number_(number) {}
  ~OpenFile() {
    if (number_ >= 0) ::close(number_);
  }
  OpenFile(OpenFile&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  OpenFile& operator=(OpenFile&&) = delete;
  [[nodiscard]] int number() const noexcept { return number_; }

 private:
  int number_;
};

}  // namespace tandem::falcon_detail
