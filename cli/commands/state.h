// What `shadestep state` shows: everything that a draw reads, or one texture or buffer of it.
#pragma once

#include <string>

#include "cli/common.h"
#include "session/session.h"
#include "session/texture_image.h"

namespace shadestep::cli {

struct StateOptions {
  std::string filter;   // names of the context's state, by globs
  std::string texture;  // a sampler's name
  int level = -1;       // -1: the base level
  int slice = 0;
  std::string buffer;  // a block's or an attribute's name, or "indices"
  std::string image, csv;
};

Json asJson(const session::ShaderTexture&);
std::string asText(const session::ShaderTexture&);
Json asJson(const session::BoundBuffer&);
std::string asText(const session::BoundBuffer&);

// One of them, as asked for; the result is the exit code. Both throw nothing_matches where there is none.
int showTexture(session::Session&, const Common&, const StateOptions&);
int showBuffer(session::Session&, const Common&, const StateOptions&);

}  // namespace shadestep::cli
