#pragma once

/// \file
/// OpenGL's functions, exported by libOpenGL: no loader is needed.
#ifndef GL_GLEXT_PROTOTYPES
#define GL_GLEXT_PROTOTYPES
#endif
#include <GL/glcorearb.h>
