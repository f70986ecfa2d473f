// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/replay/pipeline.h"

#include <array>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"

namespace shadestep::replay {
namespace {

using dispatch::gl;

struct Stage {
  GLenum type;
  GLbitfield bit;
};
constexpr std::array kStages = {Stage{GL_VERTEX_SHADER, GL_VERTEX_SHADER_BIT},
                                Stage{GL_TESS_CONTROL_SHADER, GL_TESS_CONTROL_SHADER_BIT},
                                Stage{GL_TESS_EVALUATION_SHADER, GL_TESS_EVALUATION_SHADER_BIT},
                                Stage{GL_GEOMETRY_SHADER, GL_GEOMETRY_SHADER_BIT},
                                Stage{GL_FRAGMENT_SHADER, GL_FRAGMENT_SHADER_BIT},
                                Stage{GL_COMPUTE_SHADER, GL_COMPUTE_SHADER_BIT}};

}  // namespace

std::vector<StageProgram> pipelineStages(GLuint pipeline) {
  std::vector<StageProgram> stages;
  for (const Stage& stage : kStages) {
    GLint program = 0;
    gl().GetProgramPipelineiv(pipeline, stage.type, &program);
    if (program != 0) stages.push_back({stage.type, static_cast<GLuint>(program)});
  }
  guard::clearErrors();  // asking about a stage that the context lacks is an error
  return stages;
}

GLuint copyPipeline(const std::vector<StageProgram>& stages, GLuint original, GLuint copy) {
  GLuint pipeline = 0;
  gl().GenProgramPipelines(1, &pipeline);
  for (const StageProgram& one : stages) {
    for (const Stage& stage : kStages) {
      if (stage.type != one.stage) continue;
      gl().UseProgramStages(pipeline, stage.bit, one.program == original ? copy : one.program);
    }
  }
  return pipeline;
}

}  // namespace shadestep::replay
