//! A minimal Runge-Kutta quadrotor with rotor lag and drag that uses plain arrays. Benchmarks state their times as ratios to one of its
//! steps, because these ratios barely depend on the machine's speed and load.

/// Position, velocity, attitude, angular rates and four rotor speeds.
type StateVector = [f64; 17];

fn rate(y: &StateVector, target: f64) -> StateVector {
    let mut d = [0.0; 17];
    let (v, q, w, rotors) = (&y[3..6], &y[6..10], &y[10..13], &y[13..17]);
    d[..3].copy_from_slice(v);
    let thrust: f64 = rotors.iter().map(|s| 1.0e-5 * s * s).sum();
    let speed = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    let k = -0.5 * 1.225 * 0.03 * speed / 1.3;
    let lift = -thrust / 1.3;
    d[3] = lift * 2.0 * (q[1] * q[3] + q[0] * q[2]) + k * v[0];
    d[4] = lift * 2.0 * (q[2] * q[3] - q[0] * q[1]) + k * v[1];
    d[5] = lift * (1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2])) + k * v[2] + 9.806_65;
    d[6] = 0.5 * (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2]);
    d[7] = 0.5 * (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]);
    d[8] = 0.5 * (q[0] * w[1] - q[1] * w[2] + q[3] * w[0]);
    d[9] = 0.5 * (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]);
    let f: [f64; 4] = std::array::from_fn(|i| 1.0e-5 * rotors[i] * rotors[i]);
    let torque = [0.12 * (f[1] + f[2] - f[0] - f[3]), 0.12 * (f[0] + f[2] - f[1] - f[3]), 0.016 * (f[0] + f[1] - f[2] - f[3])];
    let inertia = [0.0097, 0.0097, 0.017];
    for i in 0..3 {
        let (a, b) = ((i + 1) % 3, (i + 2) % 3);
        d[10 + i] = (torque[i] - (inertia[b] - inertia[a]) * w[a] * w[b]) / inertia[i];
    }
    for i in 13..17 {
        d[i] = (target - y[i]) / 0.03;
    }
    d
}

fn add_scaled(y: &StateVector, d: &StateVector, h: f64) -> StateVector {
    std::array::from_fn(|i| y[i] + h * d[i])
}

fn step(y: &StateVector, target: f64, h: f64) -> StateVector {
    let a = rate(y, target);
    let b = rate(&add_scaled(y, &a, 0.5 * h), target);
    let c = rate(&add_scaled(y, &b, 0.5 * h), target);
    let d = rate(&add_scaled(y, &c, h), target);
    let mut out: StateVector = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]));
    let norm = out[6..10].iter().map(|x| x * x).sum::<f64>().sqrt();
    for x in &mut out[6..10] {
        *x /= norm;
    }
    out
}

/// Runs a number of steps of 1 ms from rest.
pub fn run(steps: i64) {
    let mut y: StateVector = [0.0; 17];
    y[6] = 1.0;
    for _ in 0..steps {
        y = step(std::hint::black_box(&y), 560.0, 1e-3);
    }
    std::hint::black_box(y);
}
