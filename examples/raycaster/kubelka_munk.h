// The two-flux model of Kubelka and Munk for stacks of scattering layers (thesis 3.1.2), in a form that is
// stable for every absorption, scattering and thickness.
#pragma once

namespace raycaster {

// Reflectance and transmittance of one homogeneous layer, the same from both sides.
struct Layer {
  double r = 0, t = 1;
};

// Absorption K and scattering S per length, both >= 0, over a thickness >= 0:
//   beta = sqrt(K (K + 2 S)), q = (1 - exp(-2 beta x)) / beta (2 x where beta is 0), d = (K + S) q + 1 +
//   exp(-2 beta x), T = 2 exp(-beta x) / d, R = S q / d.
// Equal to eq. 3.20 where that can be evaluated: no sinh or cosh that overflows, no division by S.
Layer layer(double absorption, double scattering, double thickness);

// A stack that grows at its rear: what composition front to back has to keep. The reflectance of the rear is
// needed because light that the next layer sends back meets it, not the front's; eq. 3.21 as printed uses the
// front's, which is right for two layers or equal ones only.
class Stack {
 public:
  void add(const Layer&);                    // behind what is there
  double reflectance() const { return r_; }  // of the front
  double transmittance() const { return t_; }
  double rearReflectance() const { return rear_; }
  // What the whole reflects before an opaque background of that reflectance.
  double over(double background) const;

 private:
  double r_ = 0, t_ = 1, rear_ = 0;
};

}  // namespace raycaster
