// Libraries opened with RTLD_DEEPBIND look among their own before they look at us, so they would get at GL
// past us. The flag is kept, since other names depend on it; when such a library has been loaded, its imports
// of the functions that we export are pointed at ours. Runs inside the program under debug.
#include <dlfcn.h>
#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "interceptor/dispatch/libc_hooks.h"
#include "interceptor/dispatch/resolve.h"

namespace shadestep::dispatch {

namespace {

using Bases = std::vector<ElfW(Addr)>;

Bases loadedLibraries() {
  Bases bases;
  dl_iterate_phdr(
      [](dl_phdr_info* library, std::size_t, void* found) {
        static_cast<Bases*>(found)->push_back(library->dlpi_addr);
        return 0;
      },
      &bases);
  return bases;
}

// What of a loaded library's dynamic section is needed here.
struct Imports {
  const ElfW(Sym) * symbols = nullptr;
  const char* names = nullptr;
  const ElfW(Rela) * functions = nullptr;  // by the procedure linkage table
  std::size_t function_bytes = 0;
  const ElfW(Rela) * others = nullptr;
  std::size_t other_bytes = 0;
};

Imports importsOf(const dl_phdr_info& library) {
  Imports imports;
  for (int i = 0; i < library.dlpi_phnum; ++i) {
    if (library.dlpi_phdr[i].p_type != PT_DYNAMIC) continue;
    const ElfW(Addr) start = library.dlpi_addr + library.dlpi_phdr[i].p_vaddr;
    for (auto* entry = reinterpret_cast<const ElfW(Dyn)*>(start); entry->d_tag != DT_NULL; ++entry) {
      const ElfW(Addr) address = entry->d_un.d_ptr;  // made absolute by glibc
      if (entry->d_tag == DT_SYMTAB) imports.symbols = reinterpret_cast<const ElfW(Sym)*>(address);
      if (entry->d_tag == DT_STRTAB) imports.names = reinterpret_cast<const char*>(address);
      if (entry->d_tag == DT_JMPREL) imports.functions = reinterpret_cast<const ElfW(Rela)*>(address);
      if (entry->d_tag == DT_PLTRELSZ) imports.function_bytes = entry->d_un.d_val;
      if (entry->d_tag == DT_RELA) imports.others = reinterpret_cast<const ElfW(Rela)*>(address);
      if (entry->d_tag == DT_RELASZ) imports.other_bytes = entry->d_un.d_val;
    }
  }
  return imports;
}

// The page may have been made read-only after relocation.
void write(Function* slot, Function function) {
  const auto page_size = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  void* page = reinterpret_cast<void*>(reinterpret_cast<std::uintptr_t>(slot) & ~(page_size - 1));
  if (mprotect(page, page_size, PROT_READ | PROT_WRITE) == 0) *slot = function;
}

Function exportedByUs(const char* name) {
  if (std::strcmp(name, "dlsym") == 0) return reinterpret_cast<Function>(&dlsym);
  if (std::strcmp(name, "dlopen") == 0) return reinterpret_cast<Function>(&dlopen);
  const Wrapper* wrapper = findWrapper(name);
  return wrapper ? wrapper->function : nullptr;
}

void rebind(const dl_phdr_info& library, const Imports& imports, const ElfW(Rela) * first,
            std::size_t bytes) {
  for (const ElfW(Rela)* one = first; one != first + bytes / sizeof *one; ++one) {
    const auto type = ELF64_R_TYPE(one->r_info);
    if (type != R_X86_64_JUMP_SLOT && type != R_X86_64_GLOB_DAT && type != R_X86_64_64) continue;
    const ElfW(Sym)& symbol = imports.symbols[ELF64_R_SYM(one->r_info)];
    auto* slot = reinterpret_cast<Function*>(library.dlpi_addr + one->r_offset);
    if (symbol.st_shndx != SHN_UNDEF || one->r_addend != 0 || !*slot) continue;  // its own; not found
    if (Function function = exportedByUs(imports.names + symbol.st_name)) write(slot, function);
  }
}

int rebindIfNew(dl_phdr_info* library, std::size_t, void* known) {
  if (std::ranges::find(*static_cast<const Bases*>(known), library->dlpi_addr) !=
      static_cast<const Bases*>(known)->end())
    return 0;
  const Imports imports = importsOf(*library);
  if (!imports.symbols || !imports.names) return 0;
  rebind(*library, imports, imports.functions, imports.function_bytes);
  rebind(*library, imports, imports.others, imports.other_bytes);
  return 0;
}

// Whether the file is found the same way when we ask for it: `$ORIGIN` and a RUNPATH are the caller's.
bool independentOfCaller(const char* file, const void* caller) {
  if (std::strchr(file, '$')) return false;
  if (std::strchr(file, '/')) return true;
  Dl_info info;
  link_map* library = nullptr;
  if (!dladdr1(caller, &info, reinterpret_cast<void**>(&library), RTLD_DL_LINKMAP)) return false;
  for (const ElfW(Dyn)* entry = library->l_ld; entry->d_tag != DT_NULL; ++entry)
    if (entry->d_tag == DT_RUNPATH || entry->d_tag == DT_RPATH) return false;
  return true;
}

}  // namespace

}  // namespace shadestep::dispatch

LibcAnswer shadestepDlopen(const char* file, int flags, const void* caller) {
  using namespace shadestep::dispatch;
  void* real = addressOfReal("dlopen");
  const bool deep = (flags & RTLD_DEEPBIND) && !(flags & RTLD_NOLOAD);
  if (!file || !deep || insideDriver() || !independentOfCaller(file, caller)) return {real, 0};
  Bases known = loadedLibraries();
  void* handle = reinterpret_cast<void* (*)(const char*, int)>(real)(file, flags);
  if (handle) dl_iterate_phdr(rebindIfNew, &known);
  return {handle, 1};
}
