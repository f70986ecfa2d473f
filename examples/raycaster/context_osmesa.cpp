#include "context.h"
// After context.h: osmesa.h wants GL/gl.h.
#include <GL/osmesa.h>

#include <stdexcept>
#include <vector>

#include "library.h"

namespace raycaster {
namespace {

class OsmesaContext : public Context {
 public:
  OsmesaContext(Profile profile, int width, int height)
      : library_("libOSMesa.so.8", "libosmesa6"),
        colour_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4) {
    library_.load(create_, "OSMesaCreateContextAttribs");
    library_.load(destroy_, "OSMesaDestroyContext");
    library_.load(makeCurrent_, "OSMesaMakeCurrent");
    library_.load(getProcAddress_, "OSMesaGetProcAddress");

    std::vector<int> attributes = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_DEPTH_BITS, 24};
    if (profile == Profile::core)
      attributes.insert(attributes.end(), {OSMESA_PROFILE, OSMESA_CORE_PROFILE, OSMESA_CONTEXT_MAJOR_VERSION,
                                           3, OSMESA_CONTEXT_MINOR_VERSION, 3});
    attributes.push_back(0);
    context_ = create_(attributes.data(), nullptr);
    if (!context_ || !makeCurrent_(context_, colour_.data(), GL_UNSIGNED_BYTE, width, height))
      throw std::runtime_error("OSMesa gives no OpenGL 3.3 context; try --glsl 120 or a newer libosmesa6");
    finish_ = reinterpret_cast<decltype(finish_)>(address("glFinish"));
  }
  ~OsmesaContext() override { destroy_(context_); }

  AnyFunction address(const char* function) const override {
    return reinterpret_cast<AnyFunction>(getProcAddress_(function));
  }
  void present() override { finish_(); }

 private:
  Library library_;
  decltype(&::OSMesaCreateContextAttribs) create_;
  decltype(&::OSMesaDestroyContext) destroy_;
  decltype(&::OSMesaMakeCurrent) makeCurrent_;
  decltype(&::OSMesaGetProcAddress) getProcAddress_;
  decltype(&::glFinish) finish_;
  std::vector<unsigned char> colour_;  // the default framebuffer
  OSMesaContext context_ = nullptr;
};

}  // namespace

std::unique_ptr<Context> createOsmesaContext(Profile profile, int width, int height) {
  return std::make_unique<OsmesaContext>(profile, width, height);
}

}  // namespace raycaster
