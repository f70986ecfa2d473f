// QScintilla's headers want Qt's keywords, which the house's own names (frontend::emit) do not allow.
#pragma once

#define signals Q_SIGNALS
#define slots Q_SLOTS
#include <Qsci/qscilexercpp.h>
#include <Qsci/qsciscintilla.h>
#undef signals
#undef slots
