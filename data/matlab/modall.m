function out = modall(M, K, Phi, dof_map, xyz, mass, R)
% MODALL  Generalized matrices and the five mass integrals by the nodal formulas of NASA-CR-202063, 4.2.2.
%   out = MODALL(M, K, Phi, dof_map, xyz, mass) or (..., R): a struct with mass, stiffness (n x n), gamma0, gamma1,
%   alpha = gamma0 / mass (n x 3), gamma2 (n x n x 3), gamma3 (n x 3 x 3), gamma4 (n x n x 3 x 3), about the point R.
%   dof_map and xyz as in FIMAKE5. `bough integrals` calculates the same.
if nargin < 7, R = [0 0 0]; end
n = size(Phi, 2);
M_Phi = full(M * Phi);
A = treeflx_split(dof_map, size(xyz, 1), M_Phi);
phi = treeflx_split(dof_map, size(xyz, 1), full(Phi));
out.mass = Phi' * M_Phi;
out.stiffness = full(Phi' * (K * Phi));
out.gamma0 = zeros(n, 3); out.gamma1 = zeros(n, 3); out.gamma2 = zeros(n, n, 3);
out.gamma3 = zeros(n, 3, 3); out.gamma4 = zeros(n, n, 3, 3);
for k = 1:size(xyz, 1)
  p = xyz(k, :) - R(:)';
  for j = 1:n
    a = A(1:3, j, k)';
    out.gamma0(j, :) = out.gamma0(j, :) + a;
    out.gamma1(j, :) = out.gamma1(j, :) + A(4:6, j, k)' + cross(p, a);
    out.gamma3(j, :, :) = squeeze(out.gamma3(j, :, :)) + (p * a') * eye(3) - a' * p;
    for l = 1:n
      f = phi(1:3, l, k)';
      out.gamma2(j, l, :) = squeeze(out.gamma2(j, l, :))' + cross(a, f);
      out.gamma4(j, l, :, :) = squeeze(out.gamma4(j, l, :, :)) + (a * f') * eye(3) - a' * f;
    end
  end
end
out.alpha = out.gamma0 / mass;
end
