#version 120

// Where the ray enters: the point on the box's front face, in object space.

varying vec3 position;

void main()
{
    position = gl_Vertex.xyz;
    gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex;
}
