#pragma once

#include "gl/gl_object.h"

namespace tandem::view {

/// The sun's picture of depths, from which shadows are looked up.
class ShadowMap {
 public:
  /// `resolution` along each side [pixel]. Throws Error if the driver cannot make it.
  explicit ShadowMap(int resolution);

  /// Clears it and makes drawing go there, with the state that shadows need.
  void begin() const;
  /// Ends drawing and makes it the texture 0. Whoever drew elsewhere before binds that again.
  void end() const;
  [[nodiscard]] int resolution() const noexcept { return resolution_; }

 private:
  int resolution_;
  GlTexture depths_;
  GlFramebuffer frame_;
};

}  // namespace tandem::view
