// agent_scene_osmesa SCENE OUT: draws a scene into OSMesa's buffer; writes OUT.state and OUT.image.
#include "agent_scene.h"

#include <GL/osmesa.h>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const std::string name = argv[1];
  const bool core = name != "compatibility";
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            24,
                            OSMESA_STENCIL_BITS,
                            8,
                            OSMESA_PROFILE,
                            core ? OSMESA_CORE_PROFILE : OSMESA_COMPAT_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            core ? 3 : 2,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            core ? 3 : 1,
                            0};
  OSMesaContext context = OSMesaCreateContextAttribs(attributes, nullptr);
  std::vector<unsigned char> buffer(static_cast<std::size_t>(scene::kWidth) * scene::kHeight * 4);
  if (context == nullptr ||
      !OSMesaMakeCurrent(context, buffer.data(), GL_UNSIGNED_BYTE, scene::kWidth, scene::kHeight)) {
    return 5;
  }
  return scene::run(name, argv[2]);
}
