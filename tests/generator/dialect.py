"""What each version of GLSL has."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Dialect:
    version: int
    es: bool = False
    core: bool = False

    def _from(self, desktop: int, es: int = 999) -> bool:
        return self.version >= (es if self.es else desktop)

    @property
    def integers(self) -> bool:
        """uint, bit operations, wrap-around, switch, declared outputs, min and clamp of int."""
        return self._from(130, 300)

    @property
    def array_values(self) -> bool:
        """Array constructors, assignment, comparison, arrays as results; matrices that are not square."""
        return self._from(120, 300)

    @property
    def arrays_of_arrays(self) -> bool:
        return self._from(430, 310)

    @property
    def dynamic_loops(self) -> bool:
        """Loops whose bounds are no constants, and indices that are none."""
        return self._from(110, 300)

    @property
    def doubles(self) -> bool:
        return self._from(400)

    @property
    def blocks(self) -> bool:
        return self._from(140, 300)

    @property
    def memory(self) -> bool:
        """Storage buffers, images, atomic counters."""
        return self._from(430, 310)

    @property
    def locations(self) -> bool:
        return self._from(330, 300)

    @property
    def implicit(self) -> bool:
        """int to float without a constructor."""
        return self._from(120)

    @property
    def bit_functions(self) -> bool:
        return self._from(400, 310)

    @property
    def subroutines(self) -> bool:
        return self._from(400)

    @property
    def fetches(self) -> bool:
        """texelFetch, of integer textures too."""
        return self._from(130, 300)

    @property
    def int64(self) -> bool:
        """By GL_ARB_gpu_shader_int64, which Mesa has."""
        return self._from(450)

    @property
    def free_initializers(self) -> bool:
        """Globals initialized by more than constants."""
        return not self.es

    def line(self) -> str:
        profile = " es" if self.es and self.version > 100 else " core" if self.core else ""
        return f"#version {self.version}{profile}"


DIALECTS = [Dialect(110), Dialect(120), Dialect(130), Dialect(150), Dialect(330, core=True), Dialect(430, core=True),
            Dialect(450, core=True), Dialect(100, True), Dialect(300, True), Dialect(310, True)]
