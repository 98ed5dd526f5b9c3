//! Robots as models of MuJoCo, and what a simulation of them shows.

mod mjcf;
