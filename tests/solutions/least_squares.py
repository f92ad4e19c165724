def least_squares(A, y):
    theta, _, _, _ = np.linalg.lstsq(A, y)
    rest = y - A @ theta
    variance = rest @ rest / (len(y) - A.shape[1])
    covariance = variance * np.linalg.pinv(A.T @ A)
    return theta, np.sqrt(np.diag(covariance))
