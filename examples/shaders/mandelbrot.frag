#version 330 core
// Divergence: neighbours at the set's edge iterate very differently often.
uniform vec2 size;
out vec4 color;

void main()
{
    vec2 c = (gl_FragCoord.xy / size - vec2(0.7, 0.5)) * 2.6;
    vec2 z = vec2(0.0);
    int i = 0;
    for (; i < 300; ++i) {
        z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) + c;
        if (dot(z, z) > 4.0)
            break;
    }
    color = i == 300 ? vec4(0.0, 0.0, 0.0, 1.0) : vec4(vec3(sqrt(float(i) / 300.0)), 1.0);
}
