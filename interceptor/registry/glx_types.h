// The types of GLX commands. Brings in Xlib with its macros: only for files that talk to GLX.
#pragma once

#define GLX_GLXEXT_PROTOTYPES  // so that the compiler compares our signatures with the header's
#include <GL/glx.h>

namespace shadestep::dispatch {

// Of IRIX's digital media and video libraries, named by two SGIX extensions and declared nowhere on Linux.
struct DMparams;
using DMbuffer = void*;
using VLServer = void*;
using VLPath = int;
using VLNode = int;

}  // namespace shadestep::dispatch
using shadestep::dispatch::DMbuffer;
using shadestep::dispatch::DMparams;
using shadestep::dispatch::VLNode;
using shadestep::dispatch::VLPath;
using shadestep::dispatch::VLServer;
