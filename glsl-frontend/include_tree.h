// The tree of named strings that #include looks into (GL_ARB_shading_language_include). Internal to the
// front-end.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "glsl-frontend/tokens.h"

namespace shadestep::frontend {

class IncludeTree {
 public:
  explicit IncludeTree(const Includes&);

  struct Found {
    std::string location;                     // "/lib/noise.glsl"
    const std::string* text = nullptr;        // lives as long as the tree; null: there is none
    std::optional<std::string> search_point;  // where its path was relative to; none: the root
    std::string other;                        // where another driver may find another string; "" if nowhere
  };
  // `includer`: of the string that includes; null: the shader's own. `quoted`: by "", not by <>.
  Found find(const std::string& path, bool quoted, const Found* includer) const;

 private:
  Found at(const std::string& from, const std::string& path) const;

  std::map<std::string, std::string> strings_;  // by location
  std::vector<std::string> search_points_;
};

}  // namespace shadestep::frontend
