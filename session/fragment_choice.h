// Which fragments a capture shows, and which fragment tests decide on that (Strengert 2010, 7.1.3).
#pragma once

namespace shadestep::session {

struct FragmentChoice {
  enum class Switch { keep, on, off };  // as the program has it, or forced

  int layer = 0;   // of a layered target
  int sample = 0;  // of a multisampled target: what is shown is the fragment that this sample holds
  // In every replay, the uninstrumented one that it is compared with included.
  Switch alpha_test = Switch::keep;  // compatibility profiles only
  Switch depth_test = Switch::keep;
  Switch stencil_test = Switch::keep;
  Switch blend = Switch::keep;
  bool clear_buffers =
      false;  // start from buffers cleared to the program's clear values, not from a copy of its own

  bool forces() const {
    return alpha_test != Switch::keep || depth_test != Switch::keep || stencil_test != Switch::keep ||
           blend != Switch::keep || clear_buffers;
  }
};

}  // namespace shadestep::session
