// Phong shading of one light, fixed-function state, GLSL 1.10.
varying vec3 normal;
varying vec3 eye;
uniform sampler2D diffuseMap;

struct Material {
  vec4 ambient, diffuse, specular;
  float shininess;
};

Material readMaterial() {
  Material m;
  m.ambient = gl_FrontMaterial.ambient;
  m.diffuse = gl_FrontMaterial.diffuse * texture2D(diffuseMap, gl_TexCoord[0].st);
  m.specular = gl_FrontMaterial.specular;
  m.shininess = gl_FrontMaterial.shininess;
  return m;
}

vec4 shade(const Material m, vec3 n, vec3 l, vec3 v) {
  float d = max(dot(n, l), 0.0);
  vec4 sum = m.ambient * gl_LightSource[0].ambient + d * m.diffuse * gl_LightSource[0].diffuse;
  if (d > 0.0) {
    vec3 r = reflect(-l, n);
    sum += m.specular * pow(max(dot(r, v), 0.0), m.shininess);
  }
  return sum;
}

void main() {
  vec3 n = normalize(normal), v = normalize(-eye);
  vec3 l = normalize(gl_LightSource[0].position.xyz + v);
  Material m = readMaterial();
  gl_FragColor = shade(m, n, l, v);
  if (gl_FragColor.a < 0.01)
    discard;
}
