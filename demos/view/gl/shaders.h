#pragma once

namespace tandem::view::shaders {

/// \file
/// Sources in GLSL 3.30, without the version line. Points are in W [m], colours of bodies are
/// linear and those of lines and pictures are sRGB.

/// Places of a body's vertex attributes.
inline constexpr unsigned int kPoint = 0, kNormal = 1, kOrigin = 2, kTurn = 3, kColour = 4;
/// Places of a line's vertex attributes.
inline constexpr unsigned int kFrom = 0, kTo = 1, kLineColour = 2, kWidth = 3;

/// Comes before both vertex shaders of bodies.
extern const char* const kPlaceOfABody;
extern const char* const kSolidVertex;
/// With `#define GRID` it draws a net of 0.1 m on level surfaces; with SHADOWS it looks shadows up,
/// with SOFT_SHADOWS nine times for each pixel.
extern const char* const kSolidFragment;
extern const char* const kShadowVertex;
extern const char* const kShadowFragment;
extern const char* const kLineVertex;
extern const char* const kLineFragment;
extern const char* const kBackgroundVertex;
extern const char* const kBackgroundFragment;

}  // namespace tandem::view::shaders
