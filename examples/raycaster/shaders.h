// The text of shaders/*.vert and *.frag, embedded by CMake.
#pragma once

#include <string>

namespace raycaster {

enum class Glsl { v120, v330 };  // 1.20 in a compatibility context, 3.30 in a core one
enum class Classification { post, preintegrated };

std::string vertexShader(Glsl);
std::string fragmentShader(Glsl, Classification);  // sets the file's `#define PREINTEGRATED`

}  // namespace raycaster
