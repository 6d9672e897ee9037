#include "import/bullet/bullet_file.h"

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "import/import_file.h"
#include "terminal/usage_error.h"

// clang-format off
// BULLETd-v324 | code len old_pointer dna_number count | len bytes | ... | DNA1 ...
//       | |'- order of bytes: v little, V big
//       | '-- pointers: - 64 bit, _ 32 bit
//       '---- numbers: f float, d double
// clang-format on

namespace tandem::demos {
namespace {

constexpr std::size_t kHeader = 12;  // [byte]

bool hasHeader(const std::string& bytes) {
  const std::string_view text = std::string_view(bytes).substr(0, kHeader);
  return text.size() == kHeader && text.starts_with("BULLET") &&
         (text[6] == 'f' || text[6] == 'd') && (text[7] == '-' || text[7] == '_') && text[8] == 'v';
}

/// Follows the chunks to the one that describes the types. True if each lies in the file.
bool hasSoundChunks(const std::string& bytes) {
  const std::size_t pointer = bytes[7] == '-' ? 8 : 4;
  const std::size_t head = 4 + 4 + pointer + 4 + 4;
  for (std::size_t at = kHeader; at + head <= bytes.size();) {
    const std::string_view code(bytes.data() + at, 4);
    std::int32_t length = 0;
    std::memcpy(&length, bytes.data() + at + 4, sizeof length);
    if (length < 0 || static_cast<std::size_t>(length) > bytes.size() - at - head) return false;
    if (code == "DNA1") return true;
    at += head + static_cast<std::size_t>(length);
  }
  return false;
}

}  // namespace

std::string readBulletFile(const std::filesystem::path& file) {
  std::string bytes = readImportFile(file);
  if (!hasHeader(bytes))
    throw UsageError(file.string() + ": not a .bullet file of a little-endian machine");
  if (!hasSoundChunks(bytes))
    throw UsageError(file.string() + ": this .bullet file is cut off or damaged; export it again");
  return bytes;
}

}  // namespace tandem::demos
