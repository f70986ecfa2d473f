// Queries that count what is drawn, and drawing under a condition.
#include "agent_situation.h"

namespace situation {

// Every way to ask for a result, of queries that are active at the second draw.
int activeQueries() {
  glUseProgram(linked(kVertex, {kFragment}));
  constexpr GLuint kSamples = 2 * scene::kWidth * scene::kHeight;
  struct Asked {
    GLenum target;
    GLuint expected;
  };
  const Asked asked[] = {{GL_SAMPLES_PASSED, kSamples},
                         {GL_PRIMITIVES_GENERATED, 2},
                         {GL_VERTEX_SHADER_INVOCATIONS, 6},
                         {GL_CLIPPING_INPUT_PRIMITIVES, 2}};
  GLuint queries[4];
  glGenQueries(4, queries);
  for (int i = 0; i < 4; ++i) glBeginQuery(asked[i].target, queries[i]);
  draw();
  draw();
  for (const Asked& one : asked) glEndQuery(one.target);
  const auto get_u64 = opened<PFNGLGETQUERYOBJECTUI64VPROC>("glGetQueryObjectui64v");
  const auto get_s64 = opened<PFNGLGETQUERYOBJECTI64VPROC>("glGetQueryObjecti64v");
  const auto get_into = opened<PFNGLGETQUERYBUFFEROBJECTUIVPROC>("glGetQueryBufferObjectuiv");
  bool right = true;
  for (int i = 0; i < 4; ++i) {
    GLuint u = 0;
    GLint s = 0;
    GLuint64 u64 = 0;
    GLint64 s64 = 0;
    glGetQueryObjectuiv(queries[i], GL_QUERY_RESULT, &u);
    glGetQueryObjectiv(queries[i], GL_QUERY_RESULT_NO_WAIT, &s);
    get_u64(queries[i], GL_QUERY_RESULT, &u64);
    get_s64(queries[i], GL_QUERY_RESULT, &s64);
    const GLuint e = asked[i].expected;
    right = right && u == e && s == static_cast<GLint>(e) && u64 == e && s64 == e;
  }
  // Into a buffer that only OpenGL itself may write.
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_QUERY_BUFFER, buffer);
  opened<PFNGLBUFFERSTORAGEPROC>("glBufferStorage")(GL_QUERY_BUFFER, 16, nullptr, GL_MAP_READ_BIT);
  glGetQueryObjectuiv(queries[0], GL_QUERY_RESULT, reinterpret_cast<GLuint*>(8));
  glBindBuffer(GL_QUERY_BUFFER, 0);
  get_into(queries[1], buffer, GL_QUERY_RESULT, 4);
  GLuint words[4] = {};
  glBindBuffer(GL_COPY_READ_BUFFER, buffer);
  glGetBufferSubData(GL_COPY_READ_BUFFER, 0, 16, words);
  right = right && words[2] == kSamples && words[1] == 2;
  // The same query again: what it counted before is gone.
  glBeginQuery(GL_SAMPLES_PASSED, queries[0]);
  glEndQuery(GL_SAMPLES_PASSED);
  GLuint none = 7;
  glGetQueryObjectuiv(queries[0], GL_QUERY_RESULT, &none);
  return right && none == 0 && drawnEverywhere() && glGetError() == GL_NO_ERROR ? 0 : 1;
}

// The first draw is seen, the second is not; what is drawn under the conditions depends on the first.
int queriedCondition() {
  glUseProgram(linked(kVertex, {kFragment}));
  GLuint query = 0;
  glGenQueries(1, &query);
  glBeginQuery(GL_ANY_SAMPLES_PASSED, query);
  draw();
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, 0, 0);
  draw();
  glEndQuery(GL_ANY_SAMPLES_PASSED);
  glDisable(GL_SCISSOR_TEST);
  glClear(GL_COLOR_BUFFER_BIT);
  GLuint passed = 0;
  glGetQueryObjectuiv(query, GL_QUERY_RESULT, &passed);
  glBeginConditionalRender(query, GL_QUERY_WAIT_INVERTED);
  draw();
  glEndConditionalRender();
  const bool left_out = !drawnEverywhere();
  glBeginConditionalRender(query, GL_QUERY_WAIT);
  draw();
  glEndConditionalRender();
  return passed == GL_TRUE && left_out && drawnEverywhere() && glGetError() == GL_NO_ERROR ? 0 : 1;
}

int condition(bool holds) {
  glUseProgram(linked(kVertex, {kFragment}));
  GLuint query = 0;
  glGenQueries(1, &query);
  glBeginQuery(GL_SAMPLES_PASSED, query);
  glEndQuery(GL_SAMPLES_PASSED);
  glBeginConditionalRender(query, holds ? GL_QUERY_WAIT_INVERTED : GL_QUERY_WAIT);
  draw();
  glEndConditionalRender();
  return drawnEverywhere() == holds && glGetError() == GL_NO_ERROR ? 0 : 1;
}

}  // namespace situation
