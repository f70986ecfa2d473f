@version
// Single-pass volume ray casting: one fragment is one ray, followed from the box's front face until it leaves
// the box or nothing behind it would be seen.

uniform sampler3D volume;       // scalar field, 0..1
uniform vec3 camera;            // object space
uniform vec3 scale;             // object space -> texture space
uniform float stepSize;         // length of a slab, object space
@if earlyTermination
uniform float opacityLimit;     // a ray ends when it is this opaque; above 1: never
@end
@if leaping
uniform sampler2D start;        // a place before which the ray meets nothing (a = 1), or nothing is known (a = 0)
uniform float pixel;            // size of a pixel of `start`
uniform float margin;           // steps to begin before that place
@end
@if adaptive
uniform sampler3D oracle;       // how far around a place classification changes little, object space
uniform float longestSlab;      // in steps
@end

@if inside
varying vec3 position;          // object space, somewhere on the ray
@else
varying vec3 position;          // object space, on the front face
@end
@output FragColor
@if leaping
@output HitPosition
@end

@include classification
@if inside
// Where the ray enters the box: at the camera if that is inside. The second value is below the first if it misses.
vec2 boxSpan(vec3 origin, vec3 direction)
{
    vec3 inverse = 1.0 / (direction + 1e-20 * vec3(equal(direction, vec3(0.0))));
    vec3 low = -origin * inverse;
    vec3 high = (1.0 / scale - origin) * inverse;
    vec3 enter = min(low, high);
    vec3 leave = max(low, high);
    return vec2(max(max(enter.x, enter.y), max(enter.z, 0.0)), min(min(leave.x, leave.y), leave.z));
}

@end
// How many steps `dir` lead from `entry` to the far side of the unit cube.
float stepsToExit(vec3 entry, vec3 dir)
{
    vec3 farSide = step(0.0, dir);
    vec3 steps = (farSide - entry) / dir;
    return min(min(steps.x, steps.y), steps.z);
}

void main()
{
@if inside
    vec3 direction = normalize(position - camera);
    vec2 span = boxSpan(camera, direction);
    if (span.x >= span.y)
        discard;
    vec3 entry = scale * (camera + span.x * direction);
    vec3 dir = scale * stepSize * direction;
    float steps = (span.y - span.x) / stepSize;
@else
    vec3 entry = scale * position;
    vec3 dir = scale * stepSize * normalize(position - camera);
    float steps = stepsToExit(entry, dir);
@end
    int count = int(ceil(steps));
@if counting
@if leaping
    float fetches = 3.0;        // with the start's and the reprojection's own
@else
    float fetches = 1.0;
@end
@end

    vec4 dst = vec4(0.0);
    vec4 src = vec4(0.0);
@if leaping
    // The lattice of samples is that of the whole ray: what is found is what would have been found.
    vec4 known = texture(start, gl_FragCoord.xy * pixel);
    int first = 0;
    if (known.a > 0.0)
        first = int(clamp(floor(dot(known.xyz - position, normalize(position - camera)) / stepSize) - margin, 0.0, float(count)));
    float scalarOld = texture(volume, entry + float(first) * dir).r;
    float hit = -1.0;

    for (int i = first; i < count; ++i) {
@else
    float scalarOld = texture(volume, entry).r;

@if adaptive
    float done = 0.0;
    while (done < steps) {
@else
    for (int i = 0; i < count; ++i) {
@end
@end
@if adaptive
        // A slab reaches as far as little changes, but not beyond the ray's end.
        float reach = floor(texture(oracle, entry + done * dir).r / stepSize);
        float thickness = min(clamp(reach, 1.0, longestSlab), steps - done);
        vec3 pos = entry + (done + thickness) * dir;
        done += thickness;
@else
        // The last slab is as thick as what is left of the ray.
        float thickness = min(1.0, steps - float(i));
        vec3 pos = entry + (float(i) + thickness) * dir;
@end
        float scalar = texture(volume, pos).r;
@if counting
@if adaptive
        fetches += 3.0;
@else
        fetches += 2.0;
@end
@end

        // Blend the slab before this one: its lookup had time to arrive.
        dst += (1.0 - dst.a) * src;
        src = classify(scalarOld, scalar, thickness);
        scalarOld = scalar;
@if leaping

        if (hit < 0.0 && src.a > 0.0)
            hit = float(i);
@end
@if earlyTermination

        if (dst.a >= opacityLimit)
            break;
@end
    }
    dst += (1.0 - dst.a) * src;

@if leaping
    // For the next frame: the last sample before anything was met, or the ray's end.
    if (hit < 0.0)
        hit = steps;
    HitPosition = vec4(position + max(hit, 0.0) * stepSize * normalize(position - camera), 1.0);
@end
@if counting
    FragColor = vec4(fetches);
@else
    FragColor = dst;
@end
}
