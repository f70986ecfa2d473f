// The shader's own outputs beside the captured ones.
//
// gl_FragColor excludes gl_FragData, which captures need in old dialects. What it does can be said with
// gl_FragData: element 0 takes its place (it can be read as well), and the end of main copies it to the
// program's other draw buffers:
//
//   gl_FragColor.rgb = c;     ->    gl_FragData[0].rgb = c;      ... at the end: gl_FragData[1] =
//   gl_FragData[0];
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

// Does the shader mention gl_FragColor or gl_FragData? (A mention is a static use, written or not.)
bool writesFragData(const frontend::Shader&);

// GLSL statements that give every component of these outputs a value ("0", "0.25"), integers theirs.
std::string assignOutputs(const frontend::Shader&, const std::vector<frontend::VariableId>& outputs,
                          std::string_view value, std::string_view integer);

// Replaces gl_FragColor everywhere. Assumes that captures go to gl_FragData.
void replaceFragColor(Draft&);
// GLSL statements for the end of main that complete replaceFragColor; empty where gl_FragColor is not used.
std::string broadcastFragColor(const frontend::Shader&, int used_draw_buffers);
// An expression of the user's ("gl_FragColor.r") as it reads in a text with gl_FragColor replaced.
std::string withoutFragColor(const std::string& expression);

// ES lets one output go without a location only while it is alone:
//   out vec4 color;      ->    layout(location = 0) out vec4 color;
void locateOnlyOutput(Draft&);

}  // namespace shadestep::instrumenter
