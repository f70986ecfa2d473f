// A returned value, buffered so that it can be looked at on its way out. The variable has the function's
// return type and lives in a block of its own.
//
//   return e;          ->      { T sd_return; return (sd_return = (e), text, sd_return); }
//
// In ES, where no sequence holds an array:
//
//   return e;          ->      { T sd_return; sd_return = e; text; return sd_return; }
#pragma once

#include <string>

#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

// `before`: complete GLSL statements; `text`: a comma-separated list of expressions that may use
// returnedValue.
void putIntoReturn(Edits&, const Draft&, frontend::StatementId, const std::string& before,
                   const std::string& text);
std::string returnedValue(const Draft&);

// The precision that a function's header gives to its return type, which must hold for a buffer of it too:
// "highp ", or "".
std::string returnPrecision(const frontend::Shader&, const frontend::Function&);

}  // namespace shadestep::instrumenter
