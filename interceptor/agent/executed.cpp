// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/agent/executed.h"

namespace shadestep::agent {

guard::Refusal resetStorage(capture::StorageBuffer& storage, const replay::ProgramCopy& copy,
                            const wire::ExecuteT& request) {
  if (request.storage_words == 0 && request.storage.empty()) {
    storage.release();
    return {};
  }
  guard::Refusal refusal = storage.reset(request.storage, request.storage_words);
  if (refusal.text.empty() && copy.storage_binding >= 0) storage.bind(copy.storage_binding);
  return refusal;
}

}  // namespace shadestep::agent
