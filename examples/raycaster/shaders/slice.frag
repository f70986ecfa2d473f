@version
// Slicing, the baseline of ray casting: a fragment is one slab of one ray, between this plane and the next. The blending
// puts slabs together, front to back, in the target's precision.

uniform sampler3D volume;       // scalar field, 0..1
uniform vec3 camera;            // object space
uniform vec3 forward;           // the planes' normal
uniform vec3 scale;             // object space -> texture space
uniform float stepSize;         // distance of planes, object space

varying vec3 position;          // object space, on the plane
@output FragColor

@include classification
void main()
{
    // Slanted rays go through thicker slabs.
    vec3 direction = normalize(position - camera);
    float thickness = 1.0 / dot(direction, forward);
    vec3 slab = stepSize * thickness * direction;
@if post
    float scalar = texture(volume, scale * (position + 0.5 * slab)).r;
@if counting
    FragColor = vec4(2.0);
@else
    FragColor = classify(scalar, scalar, thickness);
@end
@else
    float front = texture(volume, scale * position).r;
    float back = texture(volume, scale * (position + slab)).r;
@if counting
    FragColor = vec4(3.0);
@else
    FragColor = classify(front, back, thickness);
@end
@end
}
