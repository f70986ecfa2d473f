// Makes one layer and sample of an image readable by glReadPixels. Samples cannot be read that way at all: a
// draw of the agent's own fetches them into a plain renderbuffer, which keeps every value (integers and
// floats as they are, normalized values as the floats that they mean). Runs inside the program under debug:
// throws nothing, starts no thread, calls GL only through dispatch::gl().
#pragma once

#include <map>
#include <utility>

#include "interceptor/capture/draw_target.h"
#include "interceptor/capture/image.h"
#include "interceptor/guard/context_facts.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::capture {

class PlaneReader {
 public:
  PlaneReader(const guard::ContextFacts& facts, const DrawTarget& target) : facts_(facts), target_(target) {}
  ~PlaneReader();
  PlaneReader(const PlaneReader&) = delete;
  PlaneReader& operator=(const PlaneReader&) = delete;

  // Whether the rows of the images are stored from the top: false until this says otherwise.
  void storedUpsideDown(bool yes) { upside_down_ = yes; }

  enum class Part { color, depth, stencil };

  // Binds a framebuffer for reading that holds the plane of a texture image: a layer as the attachment that
  // it is, a sample as the red, or all, components of colour attachment 0. `type`: GL_INT or GL_UNSIGNED_INT
  // for integers, anything else for the rest. With samples, another program is current afterwards.
  void bind(const Image&, Part, GLenum type, int layer, int sample);

 private:
  void fetchSample(const Image&, Part, GLenum type, int layer, int sample);
  void bindDestination(GLenum format);
  GLuint program(GLenum type);

  const guard::ContextFacts& facts_;
  const DrawTarget& target_;
  bool upside_down_ = false;
  GLuint framebuffer_ = 0;
  GLuint vertex_array_ = 0;
  std::map<GLenum, GLuint> destinations_;  // renderbuffers, by their format
  std::map<GLenum, GLuint> programs_;      // by the type that they fetch
};

}  // namespace shadestep::capture
