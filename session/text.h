// What every face says to the user in the same words, and the tables that it writes.
#pragma once

#include <cstdint>
#include <string>

#include "session/calls.h"
#include "session/thread_values.h"

namespace shadestep::session {

// "outputs identical to the uninstrumented draw (1,024 components)", and below it what the check leaves out.
std::string describe(const Check&);

// ", by at most 5.96e-08 (draw buffer 0: 0.707106769 instead of 0.707106829)"; "" where that is not known.
std::string largestDifference(const Check&);

std::string withThousands(std::uint64_t value);  // "1,048,576"

// "GL_TRIANGLES"; the number in hexadecimal if it is no primitive mode.
std::string primitiveModeName(std::uint32_t mode);
std::string errorName(std::uint32_t error);  // "GL_INVALID_ENUM"

// "glDrawArrays(mode = GL_TRIANGLES, first = 0, count = 3)", with its result, its error, and what became of
// it.
std::string describe(const LoggedCall&);

// A cell of a CSV file (RFC 4180): as it is, or in quotes where a comma, a quote or a line's end would break
// it.
std::string csvCell(const std::string& text);

// A header line, then a row for each thread that got to the place: x, y, or who else the thread is, and the
// values, a component each.
std::string asCsv(const ThreadValues&);

}  // namespace shadestep::session
