// A geometry shader that emits points of ours instead of its own vertices (thesis 7.1.3), for transform
// feedback.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

// What stands in the parentheses of `layout(triangle_strip, max_vertices = 12) out` or of another layout.
struct LayoutQualifier {
  frontend::TokenIndex name = frontend::kNone;
  frontend::TokenRange value;  // behind the '='; ends before it begins where there is none
};
// Of all layouts that `in` or `out` follows, of single variables too, in order.
std::vector<LayoutQualifier> layoutsOf(const frontend::Shader&, std::string_view in_or_out);

// layout(triangle_strip, max_vertices = 12) out; becomes layout(points, max_vertices = MOST) out;
void declarePoints(Draft&, int most);

// All calls of `function` become calls of `other`.
void replaceCalls(Draft&, std::string_view function, const std::string& other);

// The shader's own emits and ends of primitives do nothing.
void dropEmits(Draft&);

// The statements that emit a point.
std::string emitPoint();

}  // namespace shadestep::instrumenter
