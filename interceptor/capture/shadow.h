// A framebuffer of the agent's own that looks like the program's: same size, layers, samples, formats and
// contents, with capture buffers beside the copies. Replays draw here; the program's framebuffer is only
// read. Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <vector>

#include "interceptor/capture/draw_target.h"
#include "interceptor/capture/image.h"
#include "interceptor/capture/plane_reader.h"
#include "interceptor/guard/guards.h"
#include "interceptor/guard/refusal.h"
#include "interceptor/guard/section.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"
#include "wire/messages_generated.h"

namespace shadestep::capture {

// A colour buffer of 4 words a pixel that receives one output of an instrumented fragment shader.
struct CaptureBuffer {
  int location = 0;  // output location = draw buffer = colour attachment
  wire::CaptureFormat format = wire::CaptureFormat::Uint4;
  bool operator==(const CaptureBuffer&) const = default;
};

// One of the pictures that a target holds.
struct Plane {
  int layer = 0, sample = 0;
};

class Shadow {
 public:
  Shadow(const guard::ContextFacts&, const DrawTarget&);
  ~Shadow();
  Shadow(const Shadow&) = delete;
  Shadow& operator=(const Shadow&) = delete;

  enum class Start {
    copied,
    cleared
  };  // what replays start from: the program's contents as they are now, or its
      // clear values (integer buffers: 0)

  // Makes it ready for one replay: contents, captures zero, and bound for drawing with the program's draw
  // buffers and the captures. Empty text: done. The caller holds a FramebufferGuard and, for the captures, a
  // guard of their draw buffers.
  guard::Refusal fill(const guard::FramebufferGuard&, const std::vector<CaptureBuffer>& captures, Start);

  // Reads one plane of a buffer, rows from the bottom up, without gaps. The caller holds a PixelReadGuard.
  // With samples, another program is current afterwards.
  void readCapture(const CaptureBuffer&, Plane, void* words);  // 4 words a pixel
  void readOutput(const ColorBuffer&, Plane, void* words);  // 4 floats a pixel; integer formats as integers

  // All original outputs in a form that keeps every bit, plane by plane: colours as readOutput, then depth (a
  // word a pixel), then stencil (a byte a pixel). OpenGL ES cannot read depth and stencil; before OpenGL 4.3
  // no single sample of the stencil can be read.
  std::vector<guard::Section> sections() const;
  void readOriginals(std::byte* destination);

 private:
  bool build();
  void takeDefaults() const;
  void attachCaptures(const std::vector<CaptureBuffer>&);
  void copyProgramContents();
  void copyLayer(int layer);
  void blitBuffers() const;
  void clearBuffers() const;
  static void clearMarks(const CaptureBuffer&);
  void selectDrawBuffers(const std::vector<CaptureBuffer>&) const;
  void bindColor(int location, const Image&, GLenum type, Plane);
  bool readsDepth() const;
  bool readsStencil() const;
  void bindDepthStencil(PlaneReader::Part, Plane);
  void readDepth(Plane, void* words);
  void readStencil(Plane, void* bytes);
  std::size_t pixels() const;
  std::vector<Plane> planes() const;

  const guard::ContextFacts& facts_;
  const DrawTarget& target_;
  bool built_ = false;
  guard::Refusal refusal_;
  GLuint framebuffer_ = 0;
  GLuint layer_read_ = 0, layer_draw_ = 0;  // framebuffers with one layer of the program's and of the agent's
  std::deque<Image> colors_;                // as target_.colors
  std::unique_ptr<Image> depth_stencil_;
  struct Attached {
    CaptureBuffer buffer;
    std::unique_ptr<Image> image;
  };
  std::vector<Attached> captures_;
  PlaneReader reader_;
};

}  // namespace shadestep::capture
