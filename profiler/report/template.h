#pragma once

#include <string>

namespace shadestep::profiler {

std::string report_template();  // report.html, with @DATA@ where the data go

}  // namespace shadestep::profiler
