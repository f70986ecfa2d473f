#version 330 core
// Even work: every thread sums the same number of octaves, so the map should be flat.
uniform vec2 size;
out vec4 color;

float hash(vec2 p)
{
    return fract(sin(dot(p, vec2(127.1, 311.7))) * 43758.5453);
}

float noise(vec2 p)
{
    vec2 cell = floor(p);
    vec2 f = fract(p);
    f = f * f * (3.0 - 2.0 * f);
    return mix(mix(hash(cell), hash(cell + vec2(1.0, 0.0)), f.x),
               mix(hash(cell + vec2(0.0, 1.0)), hash(cell + vec2(1.0, 1.0)), f.x), f.y);
}

void main()
{
    vec2 p = gl_FragCoord.xy / size * 8.0;
    float sum = 0.0;
    float amplitude = 0.5;
    for (int octave = 0; octave < 8; ++octave) {
        sum += amplitude * noise(p);
        p = 2.03 * p + 17.0;
        amplitude *= 0.5;
    }
    color = vec4(vec3(sum), 1.0);
}
