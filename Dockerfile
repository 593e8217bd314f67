# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
#
# Two images:
#   docker build --target tools -t cartographer_ext .
#     the command line tools: docker run --rm -v "$PWD":/data -w /data cartographer_ext cartographer_ext_slam run.bag
#   docker build --target cartographer --build-context checkout=<Cartographer> -t cartographer_swapped .
#     Cartographer with our classes in front, installed in /usr/local
FROM debian:12 AS source
WORKDIR /cartographer_ext
COPY scripts/install_dependencies scripts/
RUN scripts/install_dependencies
COPY . .

FROM source AS build
RUN cmake --preset release -DCARTOGRAPHER_EXT_BUILD_TESTS=OFF \
      -DCARTOGRAPHER_EXT_PRECOMPILED_HEADERS=ON -DCARTOGRAPHER_EXT_UNITY_BUILD=ON \
    && cmake --build build/release \
    && cd build/release && cpack -G DEB && mv cartographer-ext-tools_*.deb /tools.deb

FROM debian:12-slim AS tools
COPY --from=build /tools.deb /tmp/
RUN apt-get update && apt-get install -y --no-install-recommends /tmp/tools.deb \
    && rm -rf /tmp/tools.deb /var/lib/apt/lists/*
CMD ["cartographer_ext_slam", "-help"]

FROM source AS cartographer
RUN apt-get update && apt-get install -y --no-install-recommends libboost-all-dev python3-sphinx
COPY --from=checkout . /cartographer
RUN cmake -S /cartographer -B /cartographer_build -G Ninja -DCMAKE_BUILD_TYPE=Release \
      -DCMAKE_PROJECT_cartographer_INCLUDE=/cartographer_ext/cmake/inject.cmake \
    && cmake --build /cartographer_build && cmake --install /cartographer_build
