@version
// Where the last frame's hit positions lie in this frame: one point for each of its pixels.

uniform sampler2D hits;
@if core
uniform mat4 modelViewProjection;

in vec3 vertex;                 // a pixel of `hits`, 0..1
@end
varying vec4 place;

void main()
{
@if core
    place = texture(hits, vertex.xy);
    vec4 there = modelViewProjection * vec4(place.xyz, 1.0);
@else
    place = texture(hits, gl_Vertex.xy);
    vec4 there = gl_ModelViewProjectionMatrix * vec4(place.xyz, 1.0);
@end
    // A pixel without a ray goes outside.
    gl_Position = place.a > 0.0 ? there : vec4(2.0, 2.0, 2.0, 1.0);
}
