// One draw's checks, of all that `verify` compares.
#pragma once

#include "session/verify.h"

namespace shadestep::session {

// The draw at which the session stands; the shader of the selected stage can be captured. What it finds goes
// into the report.
void verifyThisDraw(Session&, const VerifyOptions&, VerifyReport&);

}  // namespace shadestep::session
