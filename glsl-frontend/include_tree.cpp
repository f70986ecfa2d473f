#include "glsl-frontend/include_tree.h"

namespace shadestep::frontend {

namespace {

// Walks from a location ("" = the root) along a path's tokens.
std::string walk(std::string location, const std::string& path) {
  for (std::size_t at = 0; at < path.size();) {
    std::size_t end = path.find('/', at);
    if (end == std::string::npos) end = path.size();
    const std::string token = path.substr(at, end - at);
    if (token == "..") {
      location.resize(location.empty() ? 0 : location.rfind('/'));
    } else if (!token.empty() && token != ".") {
      location += '/' + token;
    }
    at = end + 1;
  }
  return location;
}

}  // namespace

IncludeTree::IncludeTree(const Includes& includes) {
  for (const auto& [path, text] : includes.named) strings_[walk("", path)] = text;
  for (const std::string& path : includes.search_paths) search_points_.push_back(walk("", path));
}

IncludeTree::Found IncludeTree::at(const std::string& from, const std::string& path) const {
  Found found{walk(from, path), nullptr, from, ""};
  if (const auto string = strings_.find(found.location); string != strings_.end())
    found.text = &string->second;
  return found;
}

// For a path in double quotes in an included string, the extension names the location where that string "had
// been found" as the first search point. Mesa takes the search point that it was found from; the string's own
// location, and the one that it lies in, could be meant as well.
IncludeTree::Found IncludeTree::find(const std::string& path, bool quoted, const Found* includer) const {
  if (path.starts_with('/')) {
    Found found = at("", path);
    found.search_point.reset();
    return found;
  }
  const bool from_includer = quoted && includer != nullptr;
  Found found;
  if (from_includer && includer->search_point) found = at(*includer->search_point, path);
  for (const std::string& point : search_points_) {
    if (found.text == nullptr) found = at(point, path);
  }
  if (!from_includer) return found;
  for (const char* up : {"..", "."}) {
    Found beside = at(walk(includer->location, up), path);
    if (beside.text == nullptr || beside.location == found.location) continue;
    if (found.text == nullptr) {
      found = std::move(beside);
    } else if (*beside.text != *found.text) {
      found.other = beside.location;
    }
  }
  return found;
}

}  // namespace shadestep::frontend
