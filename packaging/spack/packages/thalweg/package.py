from spack.package import *


class Thalweg(CMakePackage):
    """Particle-resolved solver for sediment carried by a flowing fluid: lattice Boltzmann and discrete elements,
    coupled at the surfaces of the grains.

    From the root of the source: spack repo add packaging/spack; spack dev-build --source-path . thalweg@0.1.0
    """

    version("0.1.0")

    license("BSD-3-Clause")

    variant("python", default=True, description="What thalweg analyze, plot, report and sweep need")
    variant(
        "architecture", default="x86-64-v3", description="Value of the compiler's -march", values=lambda value: True
    )

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("mpi@3.1:")
    depends_on("hdf5@1.10: +mpi")
    depends_on("sundials@6.4: +CVODE")
    depends_on("eigen@3.4:")
    depends_on("fmt@9:")
    depends_on("yaml-cpp@0.7:")
    depends_on("cli11@2.1:")
    depends_on("vtk@9.1:")
    with when("+python"):
        depends_on("python@3.11:", type=("build", "run"))
        depends_on("py-numpy", type="run")
        depends_on("py-h5py", type="run")
        depends_on("py-pyyaml", type="run")
        depends_on("py-matplotlib", type="run")

    conflicts("%gcc@:10", msg="Thalweg is C++20 and needs GCC 11 or Clang 14")
    conflicts("%clang@:13", msg="Thalweg is C++20 and needs GCC 11 or Clang 14")
    conflicts("target=aarch64:", msg="Thalweg runs on x86-64 only")

    def cmake_args(self):
        return [
            self.define("THALWEG_BUILD_TESTS", False),
            self.define("THALWEG_BUILD_BENCHMARKS", False),
            self.define_from_variant("THALWEG_ARCHITECTURE", "architecture"),
        ]
