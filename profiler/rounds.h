// How many pixels are measured: in rounds, a coarse grid first, then where the reconstruction is in doubt,
// until it is known well enough. Plain numbers; no OpenGL here.
#pragma once

#include <functional>
#include <optional>

#include "profiler/reconstruction.h"

namespace shadestep::profiler {

// Pixels that can be measured, one after the other.
class Measurable {
 public:
  virtual ~Measurable() = default;
  // Both are false when time is over or somebody asked to stop; what was measured until then is there.
  virtual bool measure(const std::vector<Sample>&) = 0;
  virtual bool again() = 0;  // all that was measured once more, for less noise

  virtual const CostMap& map() const = 0;
  virtual const std::vector<std::uint8_t>& judges() const = 0;  // per pixel
  virtual const Halves& halves() const = 0;
  virtual Grain shared() const = 0;          // pixels that share a measurement
  virtual std::size_t measured() const = 0;  // measurements, of pixels or of what shares one
  virtual int repeats() const = 0;           // of what was measured longest
};

struct Goal {
  std::optional<double> error;  // enough once the error is below that with 95% confidence
  std::optional<double> share;  // exactly this share of the pixels, in one round
  double affordable = 0;        // measurements that there is time for; may be infinite
};

// The estimate of the last round. `progress` is called after each with the share of pixels measured.
Estimate measureInRounds(Measurable&, const Guide&, const Goal&, const std::function<void(double)>& progress);

}  // namespace shadestep::profiler
