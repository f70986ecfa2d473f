// Plans for scenes: which methods a scene's facts ask for, and settings found by drawing a small pilot image
// and holding it to the reference.
#pragma once

#include "gl.h"
#include "plan.h"
#include "renderer.h"
#include "spectral_scene.h"

namespace raycaster {

struct PlannedScene {
  Scene scene;
  Plan plan;
  std::vector<std::string> leftOut;  // what is not drawn or computed, and the fact that allows it
};
struct PlannedSpectralScene {
  SpectralScene scene;
  Plan plan;
  std::vector<std::string> leftOut;
};

// The settings of `scene` are replaced by the cheapest with which the image's root mean square error stays
// within the budget (of colours from 0 to 1). `size` is the image's. A pilot is held to the reference; the
// whole image, to one drawn with far finer settings, whose own error the pilot tells (not where rays bend:
// that would take minutes). All are drawn in the current context.
PlannedScene planFor(const Gl&, Glsl, Scene, const Camera&, int size, double budget);
PlannedSpectralScene planFor(const Gl&, Glsl, SpectralScene, const Camera&, int size, double budget);

// The steps that a plan chooses from, in slabs per unit of object space, from the finest on.
const std::vector<double>& plannedSlabs();

// For people: what was chosen, what each choice costs in error, what one step cheaper would, what was left
// out.
std::string explain(const Plan&, const std::vector<std::string>& leftOut, double budget);

}  // namespace raycaster
