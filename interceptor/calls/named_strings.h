// The named strings that #include finds (GL_ARB_shading_language_include): OpenGL tells the string of a name,
// but not which names there are. Runs inside the program under debug: throws nothing, starts no thread, calls
// GL only through dispatch::gl().
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace shadestep::calls {

struct NamedString {
  std::string name;  // as the program wrote it: several names may mean one place in the tree
  std::shared_ptr<const std::string> text;
};
using NamedStrings = std::vector<NamedString>;  // in the order in which they were made

// Of the current context's share group; null while there are none. What was handed out does not change.
std::shared_ptr<const NamedStrings> namedStrings();

// While it lives, the driver has these named strings; then those of the program again.
class NamedStringsScope {
 public:
  explicit NamedStringsScope(std::shared_ptr<const NamedStrings> wanted);
  ~NamedStringsScope();
  NamedStringsScope(const NamedStringsScope&) = delete;
  NamedStringsScope& operator=(const NamedStringsScope&) = delete;

 private:
  std::shared_ptr<const NamedStrings> own_, wanted_;
};

}  // namespace shadestep::calls
