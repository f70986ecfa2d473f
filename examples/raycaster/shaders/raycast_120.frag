#version 120
#define PREINTEGRATED 0

// Single-pass volume ray casting: one fragment is one ray, followed from the box's front face until it leaves
// the box or nothing behind it would be seen.

uniform sampler3D volume;       // scalar field, 0..1
uniform vec3 camera;            // object space
uniform vec3 scale;             // object space -> texture space
uniform float stepSize;         // length of a slab, object space
uniform float opacityLimit;     // a ray ends when it is this opaque; above 1: never

varying vec3 position;               // object space, on the front face

#if PREINTEGRATED
uniform sampler2D transferFunction;   // scalar at front and back -> what a whole slab adds (associated colour)

vec4 classify(float front, float back, float thickness)
{
    vec4 slab = texture2D(transferFunction, vec2(front, back));
    if (thickness < 1.0 && slab.a > 0.0) {
        float alpha = 1.0 - pow(1.0 - slab.a, thickness);
        slab *= alpha / slab.a;
    }
    return slab;
}
#else
uniform sampler1D transferFunction;   // scalar -> colour, absorption per length

vec4 classify(float front, float back, float thickness)
{
    vec4 material = texture1D(transferFunction, 0.5 * (front + back));
    float alpha = 1.0 - exp(-material.a * stepSize * thickness);
    return vec4(alpha * material.rgb, alpha);
}
#endif

// How many steps `dir` lead from `entry` to the far side of the unit cube.
float stepsToExit(vec3 entry, vec3 dir)
{
    vec3 farSide = step(0.0, dir);
    vec3 steps = (farSide - entry) / dir;
    return min(min(steps.x, steps.y), steps.z);
}

void main()
{
    vec3 entry = scale * position;
    vec3 dir = scale * stepSize * normalize(position - camera);
    float steps = stepsToExit(entry, dir);
    int count = int(ceil(steps));

    vec4 dst = vec4(0.0);
    vec4 src = vec4(0.0);
    float scalarOld = texture3D(volume, entry).r;

    for (int i = 0; i < count; ++i) {
        // The last slab is as thick as what is left of the ray.
        float thickness = min(1.0, steps - float(i));
        vec3 pos = entry + (float(i) + thickness) * dir;
        float scalar = texture3D(volume, pos).r;

        // Blend the slab before this one: its lookup had time to arrive.
        dst += (1.0 - dst.a) * src;
        src = classify(scalarOld, scalar, thickness);
        scalarOld = scalar;

        if (dst.a >= opacityLimit)
            break;
    }
    dst += (1.0 - dst.a) * src;

    gl_FragColor = dst;
}
