// Which of the program's samplers an expression of the shader's means: a uniform, an element of an array, a
// member of a struct, or a parameter, whose calls then say it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "instrumenter/accesses.h"
#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

class ReadSamplers {
 public:
  // Keeps a reference to the draft.
  explicit ReadSamplers(Draft& draft) : draft_(draft) {}

  // What an expression means, or why that is not known.
  struct Meaning {
    std::string reason;  // "" if it is known
    SamplerKind kind;
    std::string opaque_name;
    int first = 0;                                     // sampler (of samplers())
    int count = 1;                                     // samplers that it may be, from `first` on
    std::string index;                                 // which of them: an int expression; "" = the only one
    frontend::VariableId parameter = frontend::kNone;  // its word stands in this parameter's variable
  };
  // `expression` stands in the function.
  Meaning meaningOf(frontend::TokenRange expression, const frontend::Function&);
  const std::vector<ReadSampler>& samplers() const { return samplers_; }

  // The expression for a meaning's word, given the word of sampler 0.
  std::string word(const Meaning&, int first_word) const;
  // Text around a range of tokens.
  struct Wrap {
    frontend::TokenRange range;
    std::string open, close;
  };
  // Declares the variables of parameters; what has to stand around calls to set them. To be called once,
  // after the last meaningOf.
  std::vector<Wrap> declare(int first_word);

 private:
  Meaning uniformMeaning(frontend::TokenRange expression, const frontend::Variable&);
  Meaning parameterMeaning(frontend::TokenRange expression, frontend::VariableId, const frontend::Function&);
  std::string whyUntold(const frontend::Function&, std::size_t parameter);
  int add(const std::vector<std::string>& uniforms, const SamplerKind&);

  struct Told {
    std::string reason;
    std::map<frontend::CallId, Meaning> by;  // what each call of the function gives
  };
  Draft& draft_;
  std::vector<ReadSampler> samplers_;
  std::map<std::vector<std::string>, int> known_;
  std::map<frontend::VariableId, Told> parameters_;
};

}  // namespace shadestep::instrumenter
