#include "glsl-frontend/skeleton.h"

#include "glsl-frontend/skeleton_parser.h"

namespace shadestep::frontend {

Skeleton parseSkeleton(Stage stage, const std::vector<Token>& tokens) {
  Skeleton result;
  try {
    skeleton::Parser(stage, tokens, result).parse();
  } catch (const skeleton::SyntaxError& error) {
    result.error = "line " + std::to_string(error.place.line) + ": " + error.message;
  }
  return result;
}

}  // namespace shadestep::frontend
