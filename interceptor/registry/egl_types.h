// The types of EGL commands, without the window system's headers: native handles are words here.
#pragma once

#ifndef EGL_NO_X11
#define EGL_NO_X11
#endif
#ifndef EGL_EGLEXT_PROTOTYPES
#define EGL_EGLEXT_PROTOTYPES  // so that the compiler compares our signatures with the header's
#endif
#include <EGL/egl.h>
#include <EGL/eglext.h>
