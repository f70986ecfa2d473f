// What a geometry shader makes of each input primitive, as a tree of four levels (Strengert 2010, 7.1.3 and
// figure 7.4): input primitives, the runs of the shader on them, output primitives, vertices.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "session/session.h"

namespace shadestep::session {

// GeometryEmits::value tells the outputs at the moment of its emit.
struct EmittedVertex {
  const std::uint32_t* words = nullptr;  // as captured
};

// What was emitted to one stream between two ends of a primitive: a point, a strip of lines or of triangles.
// Points are one output primitive each.
struct OutputPrimitive {
  int stream = 0;
  std::span<const EmittedVertex> vertices;
  int parts = 0;            // points, lines or triangles that it consists of
  bool ill_formed = false;  // too few vertices for a part: the driver drops it
};

// A thread of the shader.
struct GeometryRun {
  int invocation = 0;
  int vertices = 0;      // emitted, in all
  int beyond_limit = 0;  // of these, those beyond max_vertices, which the driver drops; they are in no output
  std::span<const OutputPrimitive> outputs;  // stream by stream
};

struct InputPrimitive {
  int primitive = 0;  // gl_PrimitiveIDIn
  int repeat =
      0;  // of several with this number (instances, multi-draws): in the order in which the driver ran them
  std::span<const GeometryRun> runs;  // more than one of shaders with several invocations
};

// The tree's lower levels lie one behind the other in here, the values where the draw left them: a draw may
// have millions of vertices.
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

  // Of `outputs[output]`.
  instrumenter::Value value(const EmittedVertex&, std::size_t output) const;

  struct Totals {
    std::uint64_t inputs = 0, runs = 0, silent_runs = 0, outputs = 0, ill_formed = 0, parts = 0, vertices = 0,
                  beyond_limit = 0;
  };
  Totals totals() const;

  // What `inputs` points into.
  Captured captured;
  std::vector<GeometryRun> all_runs;
  std::vector<OutputPrimitive> all_primitives;
  std::vector<EmittedVertex> all_vertices;

  GeometryEmits() = default;
  GeometryEmits(GeometryEmits&&) = default;
  GeometryEmits& operator=(GeometryEmits&&) = default;
};

// Of the draw at which the program stands. Throws nothing_matches if it has no geometry shader, cannot_debug.
GeometryEmits geometryEmits(Session&);

}  // namespace shadestep::session
