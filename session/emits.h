// What a geometry shader makes of each input primitive, as a tree of four levels (Strengert 2010, 7.1.3 and
// figure 7.4): input primitives, the runs of the shader on them, output primitives, vertices.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "session/session.h"

namespace shadestep::session {

struct EmittedVertex {
  std::vector<instrumenter::Value> values;  // of GeometryEmits::outputs, at the moment of its emit
};

// What was emitted to one stream between two ends of a primitive: a point, a strip of lines or of triangles.
// Points are one output primitive each.
struct OutputPrimitive {
  int stream = 0;
  std::vector<EmittedVertex> vertices;
  int parts = 0;            // points, lines or triangles that it consists of
  bool ill_formed = false;  // too few vertices for a part: the driver drops it
};

// A thread of the shader.
struct GeometryRun {
  int invocation = 0;
  int vertices = 0;      // emitted, in all
  int beyond_limit = 0;  // of these, those beyond max_vertices, which the driver drops; they are in no output
  std::vector<OutputPrimitive> outputs;
};

struct InputPrimitive {
  int primitive = 0;  // gl_PrimitiveIDIn
  int repeat =
      0;  // of several with this number (instances, multi-draws): in the order in which the driver ran them
  std::vector<GeometryRun> runs;  // more than one of shaders with several invocations
};

struct GeometryEmits {
  struct Output {
    std::string name;
    frontend::Type type;
    int stream = 0;  // vertices of other streams have no such output
  };
  std::vector<Output> outputs;
  std::string primitive;  // that the shader makes: "points", "line_strip", "triangle_strip"
  int max_vertices = -1;  // -1: not known
  bool repeats = false;   // some primitives have the same number
  std::vector<InputPrimitive> inputs;
  Check check;

  struct Totals {
    std::uint64_t inputs = 0, runs = 0, silent_runs = 0, outputs = 0, ill_formed = 0, parts = 0, vertices = 0,
                  beyond_limit = 0;
  };
  Totals totals() const;
};

// Of the draw at which the program stands. Throws nothing_matches if it has no geometry shader, cannot_debug.
GeometryEmits geometryEmits(Session&);

}  // namespace shadestep::session
