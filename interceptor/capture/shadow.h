// A framebuffer of the agent's own that looks like the program's: same size, formats and contents, with
// capture buffers beside the copies. Replays draw here; the program's framebuffer is only read. Runs inside
// the program under debug: throws nothing, starts no thread, calls GL only through dispatch::gl().
#pragma once

#include <cstddef>
#include <vector>

#include "interceptor/capture/draw_target.h"
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

class Shadow {
 public:
  Shadow(const guard::ContextFacts&, const DrawTarget&);
  ~Shadow();
  Shadow(const Shadow&) = delete;
  Shadow& operator=(const Shadow&) = delete;

  // Makes it ready for one replay: the program's contents as they are now, captures zero, and bound for
  // drawing with the program's draw buffers and the captures. Empty text: done. The caller holds a
  // FramebufferGuard and, for the captures, a CaptureBufferGuard.
  guard::Refusal fill(const guard::FramebufferGuard&, const std::vector<CaptureBuffer>& captures);

  // Reads one buffer, rows from the bottom up, without gaps. The caller holds a PixelReadGuard.
  void readCapture(const CaptureBuffer&, void* words) const;  // 4 words a pixel
  void readOutput(const ColorBuffer&, void* words) const;     // 4 floats a pixel; integer formats as integers

  // All original outputs in a form that keeps every bit: colours as readOutput, then depth (a word a pixel),
  // then stencil (a byte a pixel). OpenGL ES cannot read depth and stencil.
  std::vector<guard::Section> sections() const;
  void readOriginals(std::byte* destination) const;

 private:
  bool build();
  void attachCaptures(const std::vector<CaptureBuffer>&);
  void copyProgramContents() const;
  void selectDrawBuffers(const std::vector<CaptureBuffer>&) const;
  std::size_t pixels() const;

  const guard::ContextFacts& facts_;
  const DrawTarget& target_;
  bool built_ = false;
  guard::Refusal refusal_;
  GLuint framebuffer_ = 0;
  std::vector<GLuint> colors_;
  GLuint depth_stencil_ = 0;
  struct Attached {
    CaptureBuffer buffer;
    GLuint renderbuffer;
  };
  std::vector<Attached> captures_;
};

}  // namespace shadestep::capture
