@version
// Spectral volume ray casting (two-flux model of Kubelka and Munk) of up to four wavelengths: a fragment is one
// ray, followed through the volume to the backdrop. The passes over all wavelengths add up.

uniform sampler3D volume;       // scalar field, 0..1
uniform sampler2D medium;       // by scalar, row by row; a component a wavelength
uniform vec3 camera;            // object space
uniform vec3 scale;             // object space -> texture space
uniform float stepSize;         // length of a slab, object space
uniform vec3 weight0;           // RGB of the first wavelength under the light, of a white reflector
uniform vec3 weight1;
uniform vec3 weight2;
uniform vec3 weight3;
uniform float share;            // 1 / passes, so that the sum is opaque
uniform vec3 backdropOrigin;    // a plane behind the volume, object space
uniform vec3 backdropRight;
uniform vec3 backdropUp;
uniform vec3 backdropPattern;   // mean reflectance, amplitude and angular frequency of its waves
@if refraction
uniform vec3 voxel;             // size of a voxel, texture space
uniform int longest;            // steps after which a ray is given up
@end

varying vec3 position;          // object space, somewhere on the ray
@output FragColor

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

float backdrop(vec3 from, vec3 direction)
{
    vec3 forward = cross(backdropUp, backdropRight);
    float approach = dot(direction, forward);
    if (approach < 1e-3)
        return 0.0;
    vec3 there = from + dot(backdropOrigin - from, forward) / approach * direction - backdropOrigin;
    float waves = sin(backdropPattern.z * dot(there, backdropRight)) * sin(backdropPattern.z * dot(there, backdropUp));
    return backdropPattern.x + backdropPattern.y * waves;
}

@if scattering
// (1 - exp(-z)) / z for z >= 0, without cancellation where z is small.
vec4 decay(vec4 z)
{
    vec4 series = 1.0 - z / 2.0 * (1.0 - z / 3.0 * (1.0 - z / 4.0 * (1.0 - z / 5.0 * (1.0 - z / 6.0))));
    vec4 direct = (1.0 - exp(-z)) / max(z, 0.1);
    return mix(direct, series, vec4(lessThan(z, vec4(0.25))));
}

@end
@if refraction
float indexAt(float scalar)
{
    return texture(medium, vec2(scalar, 0.625)).r;
}

// How the index grows in space, by central differences of the scalar.
vec3 indexGradient(vec3 pos, float scalar)
{
    vec3 x = vec3(voxel.x, 0.0, 0.0);
    vec3 y = vec3(0.0, voxel.y, 0.0);
    vec3 z = vec3(0.0, 0.0, voxel.z);
    vec3 high = vec3(texture(volume, pos + x).r, texture(volume, pos + y).r, texture(volume, pos + z).r);
    vec3 low = vec3(texture(volume, pos - x).r, texture(volume, pos - y).r, texture(volume, pos - z).r);
    return texture(medium, vec2(scalar, 0.875)).r * 0.5 * (high - low) * scale / voxel;
}

@end
void main()
{
    vec3 direction = normalize(position - camera);
    vec2 span = boxSpan(camera, direction);
    vec3 exit = camera;

@if scattering
    vec4 reflectance = vec4(0.0);
    vec4 transmittance = vec4(1.0);
    vec4 rear = vec4(0.0);          // reflectance of the stack so far, seen from behind
@else
    vec4 depth = vec4(0.0);         // optical depth so far
@end
@if counting
    float fetches = 0.0;
@end
    if (span.x < span.y) {
@if refraction
        vec3 pos = camera + span.x * direction;
        float scalarOld = texture(volume, scale * pos).r;
        // Snell's law between layers without thickness: index times direction changes as the index does in space.
        vec3 momentum = indexAt(scalarOld) * direction;
        for (int i = 0; i < longest; ++i) {
            direction = normalize(momentum);
            float thickness = min(1.0, boxSpan(pos, direction).y / stepSize);
            if (thickness < 1e-3)
                break;
            pos += thickness * stepSize * direction;
            float scalar = texture(volume, scale * pos).r;
@else
        vec3 entry = camera + span.x * direction;
        float steps = (span.y - span.x) / stepSize;
        int count = int(ceil(steps));
        float scalarOld = texture(volume, scale * entry).r;
        for (int i = 0; i < count; ++i) {
            float thickness = min(1.0, steps - float(i));
            vec3 pos = entry + (float(i) + thickness) * stepSize * direction;
            float scalar = texture(volume, scale * pos).r;
@end
            float middle = 0.5 * (scalarOld + scalar);
@if counting
            fetches += 2.0;
@end
@if storedCoefficients
            vec4 absorption = texture(medium, vec2(middle, 0.125)) * stepSize * thickness;
@if scattering
            vec4 scattering = texture(medium, vec2(middle, 0.375)) * stepSize * thickness;
            vec4 beta = sqrt(absorption * (absorption + 2.0 * scattering));
            vec4 q = 2.0 * decay(2.0 * beta);
            vec4 d = (absorption + scattering) * q + 1.0 + exp(-2.0 * beta);
            vec4 t = 2.0 * exp(-beta) / d;
            vec4 r = scattering * q / d;
@end
@else
            // What a whole slab transmits (or stops), what it reflects.
            vec4 t = texture(medium, vec2(middle, 0.125));
@if storedOpacity
            t = 1.0 - t;
@end
            t = pow(t, vec4(thickness));
            vec4 r = texture(medium, vec2(middle, 0.375)) * thickness;
@end
@if scattering
@if counting
            fetches += 1.0;
@end
            vec4 between = 1.0 - rear * r;
            reflectance += transmittance * transmittance * r / between;
            rear = r + t * t * rear / between;
            transmittance *= t / between;
@else
            depth += absorption;
@end
@if refraction
            momentum += thickness * stepSize * indexGradient(scale * pos, scalar);
@if counting
            fetches += 7.0;
@end
@end
            scalarOld = scalar;
        }
@if refraction
        exit = pos;
@end
    }

    float behind = backdrop(exit, direction);
@if scattering
    vec4 seen = reflectance + transmittance * transmittance * behind / (1.0 - rear * behind);
@else
    vec4 seen = behind * exp(-2.0 * depth);     // there and back
@end
@if counting
    FragColor = vec4(fetches);
@else
    FragColor = vec4(seen.x * weight0 + seen.y * weight1 + seen.z * weight2 + seen.w * weight3, share);
@end
}
