#include "session/analyses.h"

#include <algorithm>

namespace shadestep::session {

const frontend::Analysis& Analyses::of(frontend::Stage stage,
                                       const std::vector<frontend::ShaderObject>& objects,
                                       const frontend::PreprocessorFacts& facts) {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.stage == stage && entry.objects == objects && entry.facts == facts;
  });
  if (found != entries_.end()) {
    entries_.splice(entries_.begin(), entries_, found);
  } else {
    entries_.push_front({stage, objects, facts, frontend::analyseLinked(stage, objects, facts)});
  }
  return entries_.front().analysis;
}

void Analyses::trim() {
  if (entries_.size() > kMostKept) entries_.resize(kMostKept);
}

}  // namespace shadestep::session
