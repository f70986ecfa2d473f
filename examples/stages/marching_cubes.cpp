// Marching cubes by a geometry shader (OpenGL 4.5): a point for each cell of the C60 volume becomes up to
// five triangles. `marching-cubes [VOXELS [IMAGE]]`: VOXELS an edge (default 32); the image is .png, .exr or
// .raw.
#include <exception>
#include <string>

#include "image_file.h"
#include "marching_cases.h"
#include "osmesa_program.h"
#include "volume.h"

static constexpr int kImageSize = 512;
static constexpr float kIsovalue = 0.5F;

static const char* const kVertex = R"glsl(#version 450
uniform int cells;  // along an edge of the volume
flat out ivec3 cell;
void main()
{
    cell = ivec3(gl_VertexID % cells, gl_VertexID / cells % cells, gl_VertexID / (cells * cells));
}
)glsl";

static const char* const kGeometry = R"glsl(#version 450
layout(points) in;
layout(triangle_strip, max_vertices = 15) out;
uniform sampler3D volume;
uniform isampler2D cases;   // a row for each case: three edges a triangle, then -1
uniform ivec2 edges[12];    // their corners
uniform float isovalue;
uniform mat3 turn;
flat in ivec3 cell[];
out vec3 normal;

ivec3 cornerAt(int corner)
{
    return cell[0] + ivec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
}

float valueAt(ivec3 voxel)
{
    ivec3 last = textureSize(volume, 0) - 1;
    return texelFetch(volume, clamp(voxel, ivec3(0), last), 0).x;
}

vec3 gradientAt(ivec3 voxel)
{
    vec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
        ivec3 side = ivec3(0);
        side[axis] = 1;
        gradient[axis] = valueAt(voxel + side) - valueAt(voxel - side);
    }
    return gradient;
}

void emitCut(int edge)
{
    ivec3 a = cornerAt(edges[edge].x);
    ivec3 b = cornerAt(edges[edge].y);
    float from = valueAt(a);
    float along = (isovalue - from) / (valueAt(b) - from);
    vec3 voxel = vec3(a) + along * vec3(b - a);
    vec3 place = turn * (2.0 * (voxel + 0.5) / vec3(textureSize(volume, 0)) - 1.0);
    normal = turn * -mix(gradientAt(a), gradientAt(b), along);
    gl_Position = vec4(place, 1.25);
    EmitVertex();
}

void main()
{
    int inside = 0;
    for (int corner = 0; corner < 8; ++corner) {
        if (valueAt(cornerAt(corner)) >= isovalue)
            inside |= 1 << corner;
    }
    for (int i = 0; i < 15; i += 3) {
        if (texelFetch(cases, ivec2(i, inside), 0).x < 0)
            break;
        for (int k = 0; k < 3; ++k)
            emitCut(texelFetch(cases, ivec2(i + k, inside), 0).x);
        EndPrimitive();
    }
}
)glsl";

static const char* const kFragment = R"glsl(#version 450
in vec3 normal;
out vec4 colour;
void main()
{
    float facing = abs(normalize(normal).z);
    colour = vec4(vec3(0.15, 0.3, 0.45) + vec3(0.75, 0.6, 0.4) * facing, 1.0);
}
)glsl";

static GLuint texture(GLenum target, int unit) {
  GLuint name = 0;
  glGenTextures(1, &name);
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(target, name);
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return name;
}

static void loadVolume(const raycaster::Volume& volume) {
  texture(GL_TEXTURE_3D, 0);
  glTexImage3D(GL_TEXTURE_3D, 0, GL_R32F, volume.size.x(), volume.size.y(), volume.size.z(), 0, GL_RED,
               GL_FLOAT, volume.voxels.data());
}

static void loadCases(GLuint program) {
  const auto cases = examples::marchingCases();
  constexpr std::size_t kRow = 16;
  std::vector<int> table(256 * kRow, -1);
  for (std::size_t i = 0; i < cases.size(); ++i)
    std::copy(cases[i].begin(), cases[i].end(), table.begin() + static_cast<std::ptrdiff_t>(i * kRow));
  texture(GL_TEXTURE_2D, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R32I, kRow, 256, 0, GL_RED_INTEGER, GL_INT, table.data());
  const auto edges = examples::cellEdges();
  glUniform2iv(glGetUniformLocation(program, "edges"), examples::kCellEdges, edges.front().data());
}

static void draw(int voxels) {
  const GLuint program = linkStages(
      {{GL_VERTEX_SHADER, kVertex}, {GL_GEOMETRY_SHADER, kGeometry}, {GL_FRAGMENT_SHADER, kFragment}});
  glUseProgram(program);
  loadVolume(raycaster::buckyball(voxels));
  loadCases(program);
  const auto uniform = [&](const char* name) { return glGetUniformLocation(program, name); };
  glUniform1i(uniform("volume"), 0);
  glUniform1i(uniform("cases"), 1);
  glUniform1i(uniform("cells"), voxels - 1);
  glUniform1f(uniform("isovalue"), kIsovalue);
  const float turn[] = {0.8F, 0.36F, 0.48F, 0.0F, 0.8F, -0.6F, -0.6F, 0.48F, 0.64F};
  glUniformMatrix3fv(uniform("turn"), 1, GL_FALSE, turn);
  GLuint vertices = 0;
  glGenVertexArrays(1, &vertices);
  glBindVertexArray(vertices);
  glEnable(GL_DEPTH_TEST);
  glClearColor(0.05F, 0.05F, 0.07F, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glDrawArrays(GL_POINTS, 0, (voxels - 1) * (voxels - 1) * (voxels - 1));
}

static raycaster::Image picture(OsmesaContext& context) {
  raycaster::Image image{kImageSize, {}};
  for (int y = 0; y < kImageSize; ++y)
    for (int x = 0; x < kImageSize; ++x)
      for (const int channel : context.pixel(x, y))
        image.pixels.push_back(static_cast<float>(channel) / 255.0F);
  return image;
}

int main(int argc, char** argv) {
  const int voxels = argc > 1 ? std::atoi(argv[1]) : 32;
  if (voxels < 2 || voxels > 256) fail("marching-cubes [VOXELS [IMAGE]], with 2 to 256 voxels");
  OsmesaContext context(OsmesaContext::Profile::core, 4, 5, kImageSize);
  draw(voxels);
  glFinish();
  try {
    if (argc > 2) raycaster::write(picture(context), argv[2]);
  } catch (const std::exception& error) {
    fail(error.what());
  }
  return glGetError() == GL_NO_ERROR ? 0 : 1;
}
