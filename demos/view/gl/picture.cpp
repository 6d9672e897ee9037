#include "gl/picture.h"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>

#include <stb_image_write.h>
#include <unistd.h>

#include "gl/gl_functions.h"
#include "gl/gl_program.h"

namespace tandem::view {
namespace {

namespace fs = std::filesystem;

constexpr std::ptrdiff_t kChannels = 4;

void appendTo(void* stream, void* bytes, int count) {
  static_cast<std::ofstream*>(stream)->write(static_cast<const char*>(bytes), count);
}

// OpenGL's first row is the lowest.
void turnUpsideDown(Picture& picture) {
  const std::ptrdiff_t row = kChannels * picture.size.width;
  auto top = picture.rgba.begin();
  auto bottom = picture.rgba.end();
  for (int y = 0; y < picture.size.height / 2; ++y, top += row) {
    bottom -= row;
    std::swap_ranges(top, top + row, bottom);
  }
}

std::string describeFailure(const fs::path& file, const std::string& reason) {
  return file.string() + ": the picture cannot be written (" + reason +
         "); check the folder, its rights and the free space";
}

bool encode(const Picture& picture, std::ofstream& stream) {
  return stbi_write_png_to_func(appendTo, &stream, picture.size.width, picture.size.height,
                                static_cast<int>(kChannels), picture.rgba.data(),
                                static_cast<int>(kChannels) * picture.size.width) != 0;
}

}  // namespace

std::array<int, 3> Picture::at(int x, int y) const {
  const auto pixel = static_cast<std::size_t>(kChannels) *
                     (static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
                      static_cast<std::size_t>(x));
  return {rgba.at(pixel), rgba.at(pixel + 1), rgba.at(pixel + 2)};
}

Picture readPicture(PictureSize size) {
  Picture picture{.size = size, .rgba = {}};
  if (size.isEmpty()) return picture;
  picture.rgba.resize(static_cast<std::size_t>(kChannels) * static_cast<std::size_t>(size.width) *
                      static_cast<std::size_t>(size.height));
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
  glReadPixels(0, 0, size.width, size.height, GL_RGBA, GL_UNSIGNED_BYTE, picture.rgba.data());
  requireNoGlError("reading a picture back");
  turnUpsideDown(picture);
  // A window's opacity is of no use in a file.
  for (std::size_t i = 3; i < picture.rgba.size(); i += kChannels) picture.rgba[i] = 255;
  return picture;
}

std::optional<std::string> writePng(const Picture& picture, const fs::path& file) {
  if (picture.size.isEmpty()) return describeFailure(file, "it has no pixels");
  fs::path unfinished = file;
  unfinished += ".part" + std::to_string(getpid());
  std::ofstream stream(unfinished, std::ios::binary | std::ios::trunc);
  if (!stream) return describeFailure(file, std::strerror(errno));
  const bool is_encoded = encode(picture, stream);
  stream.close();
  std::error_code error;
  if (!is_encoded || !stream)
    error = std::make_error_code(std::errc::io_error);
  else
    fs::rename(unfinished, file, error);
  if (!error) return std::nullopt;
  std::error_code ignored;
  fs::remove(unfinished, ignored);
  return describeFailure(file, error.message());
}

}  // namespace tandem::view
