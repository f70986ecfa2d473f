#version 330 core
// Sphere tracing: a loop whose length depends on how close a ray passes by, calls, and a second loop for shadows.
uniform vec2 size;
out vec4 color;

float distanceTo(vec3 p)
{
    float ground = p.y + 1.0;
    vec3 cell = vec3(mod(p.x + 1.5, 3.0) - 1.5, p.y, mod(p.z + 1.5, 3.0) - 1.5);
    return min(ground, length(cell) - 0.8);
}

float shadow(vec3 p, vec3 light)
{
    float t = 0.05;
    for (int i = 0; i < 40; ++i) {
        float d = distanceTo(p + t * light);
        if (d < 0.001)
            return 0.3;
        t += d;
        if (t > 12.0)
            break;
    }
    return 1.0;
}

void main()
{
    vec3 eye = vec3(0.4, 0.8, -3.0);
    vec3 ray = normalize(vec3((gl_FragCoord.xy / size - 0.5) * 1.4, 1.0));
    float t = 0.0;
    bool hit = false;
    for (int i = 0; i < 90; ++i) {
        float d = distanceTo(eye + t * ray);
        if (d < 0.001 * t) {
            hit = true;
            break;
        }
        t += d;
        if (t > 40.0)
            break;
    }
    vec3 sky = vec3(0.5, 0.7, 0.9);
    if (hit) {
        vec3 p = eye + t * ray;
        vec2 e = vec2(0.001, 0.0);
        vec3 normal = normalize(vec3(distanceTo(p + e.xyy) - distanceTo(p - e.xyy),
                                     distanceTo(p + e.yxy) - distanceTo(p - e.yxy),
                                     distanceTo(p + e.yyx) - distanceTo(p - e.yyx)));
        vec3 light = normalize(vec3(0.6, 0.8, -0.3));
        float diffuse = max(0.0, dot(normal, light)) * shadow(p + 0.01 * normal, light);
        color = vec4(mix(vec3(0.9, 0.6, 0.4) * (0.2 + diffuse), sky, min(1.0, t / 40.0)), 1.0);
    } else {
        color = vec4(sky, 1.0);
    }
}
