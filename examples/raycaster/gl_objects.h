// OpenGL objects that live as long as their owner, and the few ways in which this program makes them.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "gl.h"
#include "permutation.h"

namespace raycaster {

// RGBA of 8 (0..1), 16 (half float) or 32 bits (float) a component.
GLint colourFormat(int bits);

// Makes objects in the current context and deletes them in its destructor, where the context must be current
// again.
class Objects {
 public:
  explicit Objects(const Gl& gl) : gl_(gl) {}
  ~Objects();
  Objects(const Objects&) = delete;
  Objects& operator=(const Objects&) = delete;

  // A texture left bound to the unit; linear filtering unless `nearest`, clamped to its edge.
  GLuint texture(GLenum unit, GLenum target, bool nearest = false);
  // A size x size texture of `format`, left bound to the unit.
  GLuint image(GLenum unit, GLint format, int size);
  // Throws std::runtime_error if the driver cannot render into the textures; left bound.
  GLuint framebuffer(const std::vector<GLuint>& colours, bool depth = false, int size = 0);
  // Throws std::runtime_error with the driver's log if it refuses; attribute 0 is "vertex". Left in use.
  GLuint program(const ShaderText&);
  // Corners (three floats each) and triangles, for Mesh.
  GLuint buffer();
  GLuint vertexArray();  // left bound

 private:
  const Gl& gl_;
  std::vector<GLuint> textures_, framebuffers_, renderbuffers_, programs_, shaders_, buffers_, arrays_;
};

// Triangles or points, with the way in which the two dialects are given vertices.
class Mesh {
 public:
  Mesh(const Gl&, Objects&, Glsl);
  void set(const std::vector<float>& corners, const std::vector<unsigned>& indices);
  void draw(GLenum mode = GL_TRIANGLES) const;

 private:
  const Gl& gl_;
  Glsl glsl_;
  GLuint array_ = 0, vertices_, indices_;
  GLsizei count_ = 0;
};

// Object space to clip space, in the built-in matrix or in the uniform of the program in use.
void setMatrix(const Gl&, Glsl, GLuint program, const Eigen::Matrix4d&);
void setUniform(const Gl&, GLuint program, const char* name, const Eigen::Vector3d&);
void setUniform(const Gl&, GLuint program, const char* name, double);
void setUniform(const Gl&, GLuint program, const char* name, int);

// The corners of the box [0, extent] and its faces, counter-clockwise from outside.
void setBox(Mesh&, const Eigen::Vector3d& extent);

}  // namespace raycaster
