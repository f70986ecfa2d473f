// Detaches and deletes its shaders as soon as the program is linked, as most engines do.
#include "osmesa_program.h"

int main(int argc, char** argv) {
  OsmesaContext context;
  const GLuint vertex = compile(GL_VERTEX_SHADER, kPlainVertex);
  const GLuint fragment = compile(GL_FRAGMENT_SHADER, R"glsl(#version 120
void main()
{
    float x = gl_FragCoord.x / 64.0;
    gl_FragColor = vec4(x, 0.0, 0.0, 1.0);
}
)glsl");
  const GLuint program = glCreateProgram();
  for (const GLuint shader : {vertex, fragment}) glAttachShader(program, shader);
  glLinkProgram(program);
  for (const GLuint shader : {vertex, fragment}) {
    glDetachShader(program, shader);
    glDeleteShader(shader);
  }
  glUseProgram(program);
  drawEverywhere();
  if (context.pixel(32, 32)[0] < 120) fail("the picture is not the shader's");
  context.save(argc, argv);
}
