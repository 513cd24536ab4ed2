//! The library in programs in C, C++, Fortran and Python: the header, the symbols, the installed package, the clients, and the host programs'
//! environment.

mod c;
mod cxx;
mod description;
mod examples_under_valgrind;
mod exported_symbols;
mod fortran;
mod generated;
mod header;
mod host_environment;
mod installed_package;
mod layouts;
mod papers;
mod python;
mod python_names;
mod python_versions;
mod readmes;
mod rust_layout;
mod since;
mod stored_headers;
mod support;
