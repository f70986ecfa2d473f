#version 330 core
// Blocks of 32 x 32 pixels that differ in cost, but not inside: threads that run in step all do the same, and what
// they cost is what each costs alone. So all methods must rank the blocks alike.
uniform vec2 size;
out vec4 color;

void main()
{
    ivec2 block = ivec2(gl_FragCoord.xy) / 32;
    int iterations = int(40.0 * pow(1.15, float((7 * block.x + 11 * block.y) % 32)));
    float x = 0.3;
    for (int i = 0; i < iterations; ++i)
        x = 3.7 * x * (1.0 - x);
    color = vec4(vec3(x), 1.0);
}
