// An instrumented shader in the making: the user's tokens with edits, and what is added before and after
// them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "instrumenter/edits.h"
#include "instrumenter/instrumenter.h"

namespace shadestep::instrumenter {

// #version 100 is ES without saying so.
inline bool isEs(const frontend::Shader& shader) {
  return shader.profile == "es" || shader.version == 100;
}

class Draft {
 public:
  // Keeps a reference to the shader.
  explicit Draft(const frontend::Shader& shader);

  const frontend::Shader& shader() const { return shader_; }
  bool es() const { return isEs(shader_); }

  // "<prefix><suffix>", where no identifier of the shader begins with the prefix.
  std::string name(std::string_view suffix) const { return prefix_ + std::string(suffix); }
  // "highp " where declarations need it (ES), else "".
  std::string highp() const { return es() ? "highp " : ""; }
  // A text of helpers/ with the shader's prefix, without comments.
  std::string adapt(std::string_view helper) const;

  // Edits of the user's text. Functions cloned along a call path have edits of their own.
  Edits edits;

  void require(std::string_view extension);
  // Global declarations that come before all of the user's. A text that is already there is not added again.
  void declare(std::string_view text);
  // Function definitions that come after all of the user's text. In ES they are compiled with highp defaults.
  void append(std::string_view text);

  // The shader's text; the draft is used up.
  Result<std::string> finish();

 private:
  const frontend::Shader& shader_;
  std::string prefix_;
  std::vector<std::string> extensions_, declarations_;
  std::string definitions_;
};

}  // namespace shadestep::instrumenter
