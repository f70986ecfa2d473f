// A fragment shader that discards every other column, in a called function, and loops over the rest.
#include "osmesa_program.h"

int main(int argc, char** argv) {
  OsmesaContext context;
  glUseProgram(linkProgram(kPlainVertex, R"glsl(#version 120
void dropOddColumns(float x)
{
    if (mod(x, 2.0) >= 1.0)
        discard;
}

void main()
{
    float column = floor(gl_FragCoord.x);
    dropOddColumns(column);
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        if (float(i) > column)
            continue;
        sum += 0.25;
    }
    gl_FragColor = vec4(sum, 0.0, 1.0, 1.0);
}
)glsl"));
  drawEverywhere();
  context.save(argc, argv);
}
