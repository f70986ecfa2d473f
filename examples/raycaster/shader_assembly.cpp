#include "shader_assembly.h"

#include <sstream>
#include <stdexcept>
#include <vector>

#include "shader_parts.h"

namespace raycaster {
namespace {

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

class Assembler {
 public:
  Assembler(Glsl glsl, const std::set<std::string>& words) : glsl_(glsl), words_(words) {
    if (glsl == Glsl::v330) words_.insert("core");
  }

  void include(const std::string& name) {
    std::istringstream lines{shaderPart(name)};
    std::vector<bool> kept;  // one for every open @if
    for (std::string line; std::getline(lines, line);) {
      if (line.empty() || line[0] != '@') {
        if (all(kept)) text_ += line + '\n';
        continue;
      }
      std::istringstream words(line.substr(1));
      std::string directive, argument;
      words >> directive >> argument;
      if (directive == "if") {
        kept.push_back(words_.count(argument) > 0);
      } else if (directive == "else" && !kept.empty()) {
        kept.back() = !kept.back();
      } else if (directive == "end" && !kept.empty()) {
        kept.pop_back();
      } else if (!all(kept)) {
        continue;
      } else if (directive == "include") {
        include(argument);
      } else if (directive == "version") {
        text_ += glsl_ == Glsl::v120 ? "#version 120\n\n" : "#version 330 core\n\n";
      } else if (directive == "output") {
        if (glsl_ == Glsl::v330) text_ += "out vec4 " + argument + ";\n";
        outputs_.push_back(argument);
      } else {
        throw std::logic_error("shader part " + name + ": @" + directive);
      }
    }
    if (!kept.empty()) throw std::logic_error("shader part " + name + ": an @if without @end");
  }

  std::string text(bool vertex) {
    if (glsl_ == Glsl::v330) {
      replaceAll(text_, "varying ", vertex ? "out " : "in ");
      replaceAll(text_, "attribute ", "in ");
      return text_;
    }
    for (const char* const dimension : {"1D", "2D", "3D"}) {
      const std::string declaration = std::string("uniform sampler") + dimension + " ";
      for (auto at = text_.find(declaration); at != std::string::npos; at = text_.find(declaration, at + 1)) {
        const auto first = at + declaration.size();
        const std::string sampler = text_.substr(first, text_.find(';', first) - first);
        replaceAll(text_, "texture(" + sampler + ",",
                   std::string("texture") + dimension + "(" + sampler + ",");
      }
    }
    for (std::size_t i = 0; i < outputs_.size(); ++i)
      replaceAll(text_, outputs_[i] + " =",
                 outputs_.size() == 1 ? "gl_FragColor =" : "gl_FragData[" + std::to_string(i) + "] =");
    return text_;
  }

 private:
  static bool all(const std::vector<bool>& kept) {
    for (const bool one : kept)
      if (!one) return false;
    return true;
  }

  Glsl glsl_;
  std::set<std::string> words_;
  std::vector<std::string> outputs_;
  std::string text_;
};

}  // namespace

std::string assemble(const std::string& name, Glsl glsl, const std::set<std::string>& words) {
  Assembler assembler(glsl, words);
  assembler.include(name);
  return assembler.text(name.size() > 5 && name.substr(name.size() - 5) == ".vert");
}

}  // namespace raycaster
