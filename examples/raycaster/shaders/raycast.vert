@version
// Where the ray enters: the point on the box's front face, in object space.

@if core
uniform mat4 modelViewProjection;

in vec3 vertex;
out vec3 position;

void main()
{
    position = vertex;
    gl_Position = modelViewProjection * vec4(vertex, 1.0);
}
@else
varying vec3 position;

void main()
{
    position = gl_Vertex.xyz;
    gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex;
}
@end
