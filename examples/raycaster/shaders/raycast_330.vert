#version 330 core

// Where the ray enters: the point on the box's front face, in object space.

uniform mat4 modelViewProjection;

in vec3 vertex;
out vec3 position;

void main()
{
    position = vertex;
    gl_Position = modelViewProjection * vec4(vertex, 1.0);
}
